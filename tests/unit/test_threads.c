/* What kiln.h promises of threads: a scene may be shared, devices and what is made with them belong
 * to their threads, and any thread may cancel. The target `threads` runs it under the thread
 * sanitizer. */
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "kiln.h"
#include "support/cmocka.h"
#include "support/folders.h"

enum { WIDTH = 96, HEIGHT = 54, THREADS = 3 };

static const char *const SMALL[] = {"output.size=[96, 54]"};

static struct kiln_scene *load(const struct kiln_cancel *cancel, struct kiln_error *error)
{
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = SMALL;
    params.override_count = 1;
    params.cancel = cancel;
    return kiln_scene_load(KILN_SOURCE_DIR "/scenes/campfire.yaml", &params, error);
}

/* A job of a thread's own, of a scene that all share. */
struct job {
    const struct kiln_scene *scene;
    const struct kiln_cancel *cancel;
    const char *output;
    uint32_t last; /* frame */
    struct kiln_error error;
    uint8_t pixels[4 * WIDTH * HEIGHT]; /* of the last one */
};

static void keep(void *user, const struct kiln_frame_layer *layer)
{
    memcpy(((struct job *)user)->pixels, layer->pixels, sizeof((struct job *)user)->pixels);
}

static void *render(void *user)
{
    struct job *job = user;
    const struct kiln_frame_range range = {0, job->last};
    struct kiln_device_params cpu = kiln_device_defaults();
    struct kiln_render_params params = kiln_render_defaults();
    cpu.wanted = KILN_DEVICE_CPU;
    params.output = job->output;
    params.ranges = &range;
    params.range_count = 1;
    params.threads = 2;
    params.picture = keep;
    params.cancel = job->cancel;
    params.user = job;
    job->error = kiln_error_empty();
    struct kiln_device *device = kiln_device_open(&cpu, &job->error);
    if (device)
        kiln_render(device, job->scene, &params, NULL, &job->error);
    kiln_device_close(&device);
    return NULL;
}

static void threads_share_a_scene(void **state)
{
    (void)state;
    static struct job jobs[THREADS];
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene *scene = load(NULL, &error);
    pthread_t threads[THREADS];
    for (int i = 0; i < THREADS; i++) {
        jobs[i] = (struct job){.scene = scene, .last = 2};
        assert_int_equal(pthread_create(&threads[i], NULL, render, &jobs[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
        assert_string_equal(jobs[i].error.message, "");
        assert_memory_equal(jobs[i].pixels, jobs[0].pixels, sizeof jobs[0].pixels);
    }
    kiln_scene_destroy(&scene);
}

static void any_thread_may_cancel(void **state)
{
    (void)state;
    static struct job job;
    struct kiln_error error = kiln_error_empty();
    struct kiln_cancel *cancel = kiln_cancel_create();
    struct kiln_scene *scene = load(NULL, &error);
    pthread_t thread;
    assert_false(kiln_cancel_is_requested(cancel));
    job = (struct job){.scene = scene, .cancel = cancel, .output = "f_####.png", .last = 149};
    assert_int_equal(pthread_create(&thread, NULL, render, &job), 0);
    while (access("f_0000.png", F_OK) != 0)
        usleep(1000);
    kiln_cancel_request(cancel);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_int_equal(job.error.code, KILN_INTERRUPTED);
    assert_int_equal(access("f_0149.png", F_OK), -1);

    assert_null(load(cancel, &error)); /* its pictures are decoded, which asks */
    assert_int_equal(error.code, KILN_INTERRUPTED);
    kiln_scene_destroy(&scene);
    kiln_cancel_destroy(&cancel);
    assert_false(kiln_cancel_is_requested(NULL));
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_share_a_scene),
        cmocka_unit_test_setup_teardown(any_thread_may_cancel, test_enter_folder,
                                        test_leave_folder),
    };
    return cmocka_run_group_tests_name("threads", tests, NULL, NULL);
}
