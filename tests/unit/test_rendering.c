/* A job frame by frame, in a loop of the program's own. */
#include <string.h>
#include <unistd.h>

#include "kiln.h"
#include "support/cmocka.h"
#include "support/folders.h"

static struct kiln_device *device;
static struct kiln_scene *scene;

static struct kiln_device *open_cpu(void)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_device_params cpu = kiln_device_defaults();
    cpu.wanted = KILN_DEVICE_CPU;
    return kiln_device_open(&cpu, &error);
}

static int set_up(void **state)
{
    (void)state;
    static const char *const small[] = {"output.size=[48, 32]", "output.frames=6"};
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = small;
    params.override_count = 2;
    device = open_cpu();
    scene = kiln_scene_load(KILN_SOURCE_DIR "/scenes/embers.yaml", &params, &error);
    return device && scene ? 0 : 1;
}

static int tear_down(void **state)
{
    (void)state;
    kiln_scene_destroy(&scene);
    kiln_device_close(&device);
    return 0;
}

static struct kiln_rendering *begin(const char *output, const struct kiln_frame_range *ranges,
                                    size_t count)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_render_params params = kiln_render_defaults();
    params.output = output;
    params.ranges = ranges;
    params.range_count = count;
    params.state_hash = true;
    struct kiln_rendering *rendering = kiln_rendering_begin(device, scene, &params, &error);
    if (!rendering)
        fail_msg("%s", error.message);
    return rendering; /* it has its own copy of the parameters */
}

static bool next(struct kiln_rendering *rendering, struct kiln_progress *progress)
{
    struct kiln_error error = kiln_error_empty();
    bool drawn = false;
    if (!kiln_rendering_next(rendering, &drawn, progress, &error))
        fail_msg("%s", error.message);
    return drawn;
}

/* Two jobs in turn draw what one call would, each in its ranges. */
static void jobs_can_take_turns(void **state)
{
    (void)state;
    static const struct kiln_frame_range ranges[] = {{1, 2}, {3, 3}, {5, 5}};
    static const uint32_t wanted[] = {1, 2, 3, 5};
    struct kiln_error error = kiln_error_empty();
    struct kiln_rendering *whole = begin("a_##.png", NULL, 0), *some = begin(NULL, ranges, 3);
    struct kiln_state_hash states[6];
    for (uint32_t frame = 0; frame < 6; frame++) {
        struct kiln_device *other = open_cpu(); /* is current in between */
        struct kiln_progress progress = kiln_progress_empty();
        assert_true(next(whole, &progress));
        assert_true(progress.frame == frame && progress.done == frame + 1 && progress.total == 6);
        states[frame] = progress.state;
        kiln_device_close(&other);
    }
    for (size_t i = 0; i < 4; i++) {
        struct kiln_progress progress = kiln_progress_empty();
        assert_true(next(some, &progress));
        assert_int_equal(progress.frame, wanted[i]);
        assert_memory_equal(&progress.state, &states[wanted[i]], sizeof progress.state);
    }
    assert_false(next(whole, NULL));
    assert_false(next(whole, NULL));
    assert_false(next(some, NULL));
    struct kiln_render_stats stats = kiln_render_stats_empty();
    assert_true(kiln_rendering_end(&whole, &stats, &error) && !whole);
    assert_true(stats.frames == 6 && stats.files == 6);
    assert_true(kiln_rendering_end(&some, NULL, &error) && !some);
    assert_int_equal(access("a_05.png", F_OK), 0);
}

static void a_job_that_is_given_up_leaves_whole_frames(void **state)
{
    (void)state;
    struct kiln_error error = kiln_error_empty();
    struct kiln_rendering *images = begin("b_##.png", NULL, 0), *clip = begin("b.mp4", NULL, 0);
    for (int i = 0; i < 3; i++)
        assert_true(next(images, NULL) && next(clip, NULL));
    assert_false(kiln_rendering_end(&images, NULL, &error));
    assert_int_equal(error.code, KILN_INTERRUPTED);
    assert_false(kiln_rendering_end(&clip, NULL, &error));
    assert_int_equal(error.code, KILN_INTERRUPTED);
    assert_int_equal(access("b_05.png", F_OK), -1);
    assert_int_equal(access("b.mp4", F_OK), -1);
    assert_null(clip);
}

static void what_cannot_begin_says_why(void **state)
{
    (void)state;
    static const struct kiln_frame_range range = {4, 6};
    struct kiln_error error = kiln_error_empty();
    struct kiln_render_params params = kiln_render_defaults();
    params.ranges = &range;
    params.range_count = 1;
    assert_null(kiln_rendering_begin(device, scene, &params, &error));
    assert_int_equal(error.code, KILN_USAGE);
    assert_string_equal(error.message, "frames 4-6: expected ascending ranges within 0-5");
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(jobs_can_take_turns),
        IN_FOLDER(a_job_that_is_given_up_leaves_whole_frames),
        IN_FOLDER(what_cannot_begin_says_why),
    };
    return cmocka_run_group_tests_name("rendering", tests, set_up, tear_down);
}
