/* What kiln.h promises of threads: a scene may be shared, devices and what is made with them belong
 * to their threads, and any thread may cancel. The target `threads` runs it under the thread
 * sanitizer. */
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "kiln.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"

enum { WIDTH = 96, HEIGHT = 54, THREADS = 3 };

#define SCENE KILN_SOURCE_DIR "/scenes/campfire.yaml"

static const char *const SMALL[] = {"output.size=[96, 54]", "gas.fire.cells=32"};

static struct kiln_scene *load(const struct kiln_cancel *cancel, struct kiln_error *error)
{
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = SMALL;
    params.override_count = sizeof SMALL / sizeof *SMALL;
    params.cancel = cancel;
    return kiln_scene_load(SCENE, &params, error);
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
    expect_error(&job.error, KILN_INTERRUPTED, "stopped");
    assert_int_equal(access("f_0149.png", F_OK), -1);

    assert_null(load(cancel, &error)); /* its pictures are decoded, which asks */
    expect_error(&error, KILN_INTERRUPTED,
                 "%s:20:18: backdrop.floor.image: 'textures/soil.jpg': stopped while reading the "
                 "files of a scene",
                 SCENE);
    kiln_scene_destroy(&scene);
    kiln_cancel_destroy(&cancel);
    assert_false(kiln_cancel_is_requested(NULL));
}

/* A job and its device, which another thread tries to use. */
struct foreign {
    struct kiln_device *device;
    struct kiln_scene *scene;
    struct kiln_rendering *job;
    struct kiln_error next, take, end, begin, render, bake, plan, export;
    bool refused; /* all calls failed, and the job was not ended */
};

static void *use(void *user)
{
    struct foreign *f = user;
    bool drawn = true;
    struct kiln_render_stats stats = kiln_render_stats_empty();
    struct kiln_bake_params baking = kiln_bake_defaults();
    struct kiln_rendering *job = f->job;
    baking.states = "states";
    f->refused = !kiln_rendering_next(job, &drawn, NULL, &f->next) && !drawn &&
                 !kiln_rendering_take_frame(job, &f->take) &&
                 !kiln_rendering_end(&job, &stats, &f->end) && job == f->job &&
                 !kiln_rendering_begin(f->device, f->scene, NULL, &f->begin) &&
                 !kiln_render(f->device, f->scene, NULL, NULL, &f->render) &&
                 !kiln_bake(f->device, f->scene, &baking, NULL, &f->bake) &&
                 !kiln_plan_tasks(f->device, f->scene, NULL, NULL, &f->plan) &&
                 !kiln_export(f->device, f->scene, NULL, NULL, &f->export);
    return NULL;
}

static void assert_refused(const struct kiln_error *error, const char *message)
{
    assert_string_equal(error->message, message);
    assert_int_equal(error->code, KILN_USAGE);
}

static void another_thread_cannot_use_a_job_or_its_device(void **state)
{
    (void)state;
    static const struct kiln_frame_range ranges = {0, 1};
    static struct foreign f;
    static const char job[] =
        "the job belongs to another thread: the one that began it draws and ends it";
    static const char device[] = "the device belongs to another thread: open one in each";
    struct kiln_error error = kiln_error_empty();
    struct kiln_device_params cpu = kiln_device_defaults();
    struct kiln_render_params params = kiln_render_defaults();
    bool drawn = false;
    pthread_t thread;
    cpu.wanted = KILN_DEVICE_CPU;
    params.ranges = &ranges;
    params.range_count = 1;
    params.keep_frames = true;
    f.scene = load(NULL, &error);
    f.device = kiln_device_open(&cpu, &error);
    f.job = kiln_rendering_begin(f.device, f.scene, &params, &error);
    assert_true(kiln_rendering_next(f.job, &drawn, NULL, &error) && drawn);

    assert_int_equal(pthread_create(&thread, NULL, use, &f), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_true(f.refused);
    assert_refused(&f.next, job);
    assert_refused(&f.take, job);
    assert_refused(&f.end, job);
    assert_refused(&f.begin, device);
    assert_refused(&f.render, device);
    assert_refused(&f.bake, device);
    assert_refused(&f.plan, device);
    assert_refused(&f.export, device);

    struct kiln_frame *frame = kiln_rendering_take_frame(f.job, &error);
    assert_non_null(frame); /* the job goes on as if nobody had called */
    kiln_frame_destroy(&frame);
    assert_true(kiln_rendering_next(f.job, &drawn, NULL, &error) && drawn);
    assert_true(kiln_rendering_next(f.job, &drawn, NULL, &error) && !drawn);
    assert_true(kiln_rendering_end(&f.job, NULL, &error));
    kiln_device_close(&f.device);
    kiln_scene_destroy(&f.scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_share_a_scene),
        cmocka_unit_test_setup_teardown(another_thread_cannot_use_a_job_or_its_device,
                                        test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(any_thread_may_cancel, test_enter_folder,
                                        test_leave_folder),
    };
    return cmocka_run_group_tests_name("threads", tests, NULL, NULL);
}
