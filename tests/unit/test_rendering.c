/* A job frame by frame, in a loop of the program's own, and what it keeps of frames and scenes. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "kiln.h"
#include "support/cmocka.h"
#include "support/errors.h"
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
    expect_error(&error, KILN_INTERRUPTED, "ended before the last frame");
    assert_false(kiln_rendering_end(&clip, NULL, &error));
    expect_error(&error, KILN_INTERRUPTED, "ended before the last frame");
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
    expect_error(&error, KILN_USAGE, "frames 4-6: expected ascending ranges within 0-5");
}

/* What was told of a frame while it was drawn. */
struct told {
    uint8_t display[48 * 32 * 4];
    float beauty[48 * 32 * 4];
};

static void listen(void *user, const struct kiln_frame_layer *layer)
{
    struct told *told = (struct told *)user + layer->frame;
    if (strcmp(layer->layer, "display") == 0)
        memcpy(told->display, layer->pixels, sizeof told->display);
    else
        memcpy(told->beauty, layer->pixels, sizeof told->beauty);
}

/* told: of each frame one, or NULL. */
static struct kiln_rendering *begin_keeping(const char *output, struct told *told)
{
    static const char *const layers[] = {"display", "beauty"};
    struct kiln_error error = kiln_error_empty();
    struct kiln_render_params params = kiln_render_defaults();
    params.output = output;
    params.layers = layers;
    params.layer_count = 2;
    params.keep_frames = true;
    params.picture = told ? listen : NULL;
    params.user = told;
    struct kiln_rendering *rendering = kiln_rendering_begin(device, scene, &params, &error);
    if (!rendering)
        fail_msg("%s", error.message);
    return rendering;
}

static struct kiln_frame_layer layer_of(const struct kiln_frame *frame, const char *name)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_frame_layer layer = kiln_frame_layer_empty();
    if (!kiln_frame_get_layer(frame, name, &layer, &error))
        fail_msg("%s", error.message);
    return layer;
}

/* Frames have what `picture` was told, also when later frames, outputs and the job are gone. */
static void frames_outlive_their_job(void **state)
{
    (void)state;
    static struct told told[6];
    struct kiln_error error = kiln_error_empty();
    struct kiln_frame *frames[6];
    struct kiln_rendering *heard = begin_keeping(NULL, told);
    while (next(heard, NULL))
        continue;
    assert_true(kiln_rendering_end(&heard, NULL, &error));
    struct kiln_rendering *job = begin_keeping("kept_##.png", NULL);
    assert_null(kiln_rendering_take_frame(job, &error));
    expect_error(&error, KILN_USAGE, "no frame was drawn since one was taken");
    for (size_t i = 0; i < 6; i++) {
        assert_true(next(job, NULL));
        frames[i] = kiln_rendering_take_frame(job, &error);
        assert_non_null(frames[i]);
        assert_null(kiln_rendering_take_frame(job, &error));
    }
    assert_false(next(job, NULL));
    assert_true(kiln_rendering_end(&job, NULL, &error));
    for (uint32_t i = 0; i < 6; i++) {
        struct kiln_frame_layer layer = layer_of(frames[i], "display");
        assert_true(layer.frame == i && layer.width == 48 && layer.height == 32);
        assert_true(layer.channels == 4 && layer.samples == KILN_SAMPLES_UINT8);
        assert_memory_equal(layer.pixels, told[i].display, sizeof told[i].display);
        layer = layer_of(frames[i], "beauty");
        assert_memory_equal(layer.pixels, told[i].beauty, sizeof told[i].beauty);
        assert_false(kiln_frame_get_layer(frames[i], "fire", &layer, &error));
        expect_error(&error, KILN_USAGE, "frame %u has no layer 'fire'", i);
        kiln_frame_destroy(&frames[i]);
        assert_null(frames[i]);
    }
    struct kiln_rendering *none = begin(NULL, NULL, 0);
    assert_true(next(none, NULL));
    assert_null(kiln_rendering_take_frame(none, &error));
    expect_error(&error, KILN_USAGE, "frames are not kept: set keep_frames to take them");
    assert_false(kiln_rendering_end(&none, NULL, &error));
}

/* A layer that is written looks like the job's own file. */
static void layers_are_written_as_pictures(void **state)
{
    (void)state;
    struct kiln_error error = kiln_error_empty();
    struct kiln_rendering *job = begin_keeping("job_##.png", NULL);
    assert_true(next(job, NULL));
    struct kiln_frame *frame = kiln_rendering_take_frame(job, &error);
    while (next(job, NULL)) {
    }
    assert_true(kiln_rendering_end(&job, NULL, &error));
    struct kiln_frame_layer display = layer_of(frame, "display"),
                            beauty = layer_of(frame, "beauty");
    assert_true(kiln_layer_write(&display, "written.png", false, &error));
    assert_true(kiln_layer_write(&beauty, "written.exr", false, &error));
    struct kiln_compare_params params = kiln_compare_defaults();
    struct kiln_compare_result result = kiln_compare_result_empty();
    static const char *const exact[] = {"flip.max=0"};
    params.reference = "job_00.png";
    params.test = "written.png";
    params.limits = exact;
    params.limit_count = 1;
    assert_true(kiln_compare(&params, &result, &error) && result.same);
    params.reference = params.test = "written.exr";
    assert_true(kiln_compare(&params, &result, &error) && result.same && result.hdr);

    assert_false(kiln_layer_write(&display, "written.png", false, &error));
    expect_error(&error, KILN_USAGE, "written.png: the file exists (--force replaces it)");
    assert_true(kiln_layer_write(&display, "written.png", true, &error));
    assert_false(kiln_layer_write(&display, "display.exr", false, &error));
    expect_error(&error, KILN_USAGE, "display.exr: integer samples go into a file '*.png'");
    display.channels = 3;
    assert_false(kiln_layer_write(&display, "three.png", false, &error));
    expect_error(&error, KILN_USAGE, "three.png: found 3 channels; allowed are 4");
    display.channels = 4;
    display.row_bytes = 47 * 4;
    assert_false(kiln_layer_write(&display, "short.png", false, &error));
    expect_error(&error, KILN_USAGE, "short.png: found rows of 188 bytes; 48 pixels have 192");
    display.width = 0;
    assert_false(kiln_layer_write(&display, "none.png", false, &error));
    expect_error(&error, KILN_USAGE,
                 "none.png: found 0 x 32 pixels; allowed are 1 to 16384 a side");
    assert_int_equal(access("three.png", F_OK), -1);
    kiln_frame_destroy(&frame);
}

/* The text in memory is what kiln_scene_print writes, however little room there is. */
static void a_scene_is_a_text_in_memory(void **state)
{
    (void)state;
    static char printed[65536], text[65536];
    FILE *file = fopen("printed.yaml", "w+");
    assert_true(file && kiln_scene_print(scene, file));
    rewind(file);
    const size_t length = fread(printed, 1, sizeof printed, file);
    fclose(file);
    assert_int_equal(kiln_scene_text(scene, NULL, 0), length);
    assert_int_equal(kiln_scene_text(scene, text, sizeof text), length);
    assert_string_equal(text, printed);
    assert_int_equal(kiln_scene_text(scene, text, 9), length);
    assert_true(strlen(text) == 8 && strncmp(text, printed, 8) == 0 && text[9] == printed[9]);
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(jobs_can_take_turns),
        IN_FOLDER(a_job_that_is_given_up_leaves_whole_frames),
        IN_FOLDER(frames_outlive_their_job),
        IN_FOLDER(layers_are_written_as_pictures),
        IN_FOLDER(a_scene_is_a_text_in_memory),
        IN_FOLDER(what_cannot_begin_says_why),
    };
    return cmocka_run_group_tests_name("rendering", tests, set_up, tear_down);
}
