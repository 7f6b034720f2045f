/* A job on a scene or device that was destroyed, or on a pointer to something else, is an error in
 * a debug build. If this fails, a program with such a mistake crashes, or draws rubbish, without a
 * word on the cause. The checks are in lib/base/handle.c, which is compiled into this program as
 * for a debug build. Only beside the address sanitizer there are none, and most of these tests are
 * skipped. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/handle.h"
#include "kiln.h"
#include "support/cmocka.h"
#include "support/folders.h"

static const char tiny[] = "kiln: 1\n"
                           "output: {size: [16, 16], frames: 3}\n"
                           "systems: {a: {emit: {rate: 20, life: 1 s}}}\n";

static void skip_without_checks(void)
{
    if (KILN_HANDLES_ARE_CHECKED)
        return;
    print_message("nothing is checked here: the address sanitizer checks lifetimes itself\n");
    skip();
}

static struct kiln_scene *parse(void)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene *scene = kiln_scene_parse(tiny, strlen(tiny), "tiny", NULL, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

static struct kiln_device *open_cpu(void)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_device_params cpu = kiln_device_defaults();
    cpu.wanted = KILN_DEVICE_CPU;
    struct kiln_device *device = kiln_device_open(&cpu, &error);
    if (!device)
        fail_msg("%s", error.message);
    return device;
}

/* Begins a job of each kind, all of which must fail with this message. */
static void assert_refused(struct kiln_device *device, const struct kiln_scene *scene,
                           const char *message)
{
    struct kiln_error errors[5];
    struct kiln_bake_params baking = kiln_bake_defaults();
    baking.states = "states";
    for (size_t i = 0; i < 5; i++)
        errors[i] = kiln_error_empty();
    assert_null(kiln_rendering_begin(device, scene, NULL, &errors[0]));
    assert_false(kiln_render(device, scene, NULL, NULL, &errors[1]));
    assert_false(kiln_bake(device, scene, &baking, NULL, &errors[2]));
    assert_false(kiln_plan_tasks(device, scene, NULL, NULL, &errors[3]));
    assert_false(kiln_export(device, scene, NULL, NULL, &errors[4]));
    for (size_t i = 0; i < 5; i++) {
        assert_string_equal(errors[i].message, message);
        assert_int_equal(errors[i].code, KILN_USAGE);
    }
}

/* In every build. */
static void null_is_refused(void **state)
{
    (void)state;
    struct kiln_scene *scene = parse();
    struct kiln_device *device = open_cpu();
    assert_refused(NULL, scene, "found NULL, expected a device");
    assert_refused(device, NULL, "found NULL, expected a scene");
    kiln_device_close(&device);
    kiln_scene_destroy(&scene);
}

static void what_was_destroyed_is_refused(void **state)
{
    (void)state;
    skip_without_checks();
    struct kiln_scene *scene = parse(), *destroyed = scene;
    struct kiln_device *device = open_cpu(), *closed = device;
    kiln_scene_destroy(&scene);
    assert_refused(device, destroyed, "the scene was destroyed; it must outlive its jobs");
    scene = parse(); /* new memory does not lie where a caller may still point to */
    assert_ptr_not_equal(scene, destroyed);
    kiln_device_close(&device);
    assert_refused(closed, scene, "the device was closed; it must outlive its jobs");
    kiln_scene_destroy(&destroyed); /* a second time: nothing happens */
    kiln_device_close(&closed);
    kiln_scene_destroy(&scene);
}

static void what_is_something_else_is_refused(void **state)
{
    (void)state;
    skip_without_checks();
    static const uint64_t other[64] = {1, 2, 3};
    struct kiln_scene *scene = parse();
    struct kiln_device *device = open_cpu();
    assert_refused((struct kiln_device *)scene, scene,
                   "found a pointer to a scene, expected a device");
    assert_refused(device, (const struct kiln_scene *)device,
                   "found a pointer to a device, expected a scene");
    assert_refused(device, (const struct kiln_scene *)other,
                   "found a pointer to something else, expected a scene");
    kiln_device_close(&device);
    kiln_scene_destroy(&scene);
}

/* Destroys the scene, or closes the device, of a job that has drawn a frame. Its next call and its
 * end report that, and the end leaves no half-written file. */
static void destroy_under_a_job(bool of_scene, const char *message)
{
    struct kiln_error error = kiln_error_empty(), at_end = kiln_error_empty();
    struct kiln_scene *scene = parse();
    struct kiln_device *device = open_cpu();
    struct kiln_render_params params = kiln_render_defaults();
    params.output = "clip.mp4";
    struct kiln_rendering *job = kiln_rendering_begin(device, scene, &params, &error);
    bool drawn = false;
    assert_true(job && kiln_rendering_next(job, &drawn, NULL, &error) && drawn);
    if (of_scene)
        kiln_scene_destroy(&scene);
    else
        kiln_device_close(&device);
    assert_false(kiln_rendering_next(job, &drawn, NULL, &error));
    assert_string_equal(error.message, message);
    assert_int_equal(error.code, KILN_USAGE);
    assert_false(kiln_rendering_end(&job, NULL, &at_end));
    assert_string_equal(at_end.message, message);
    assert_null(job);
    assert_int_equal(access("clip.mp4", F_OK), -1);
    kiln_device_close(&device);
    kiln_scene_destroy(&scene);
}

static void what_a_job_needs_is_missed(void **state)
{
    (void)state;
    skip_without_checks();
    destroy_under_a_job(true, "the scene was destroyed; it must outlive its jobs");
    destroy_under_a_job(false, "the device was closed; it must outlive its jobs");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(null_is_refused),
        cmocka_unit_test(what_was_destroyed_is_refused),
        cmocka_unit_test(what_is_something_else_is_refused),
        cmocka_unit_test_setup_teardown(what_a_job_needs_is_missed, test_enter_folder,
                                        test_leave_folder),
    };
    return cmocka_run_group_tests_name("lifetimes", tests, NULL, NULL);
}
