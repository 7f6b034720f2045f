/* Checks the frame loop (lib/frame/loop.c), which renders the frames of a job one after another.
 * Jobs of one process run side by side, are stopped, leave out frames, or continue with another
 * job's particles. If this fails, a frame's bytes depend on what else is rendered or left out, or a
 * stopped clip leaves a file. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "job/job.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/pictures.h"
#include "support/scenes.h"

enum { FRAMES = 4 };

static const char SMOKE[] =
    "kiln: 1\n"
    "output: {size: [64, 48], fps: 30, frames: 4}\n"
    "systems:\n"
    "  smoke:\n"
    "    emit: {rate: 200, life: 1 s, speed: 2 m/s, from: {sphere: {origin: [0, 1, 0]}}}\n"
    "    look: {atlas: 'builtin:smoke', size: 0.8 m, opacity: 0.8, lit: 1, bloom: 0.5}\n";
static const char FIRE[] =
    "kiln: 1\n"
    "output: {size: [32, 32], fps: 30, frames: 2}\n"
    "camera: {position: [3, 1, 1]}\n"
    "backdrop: {transparent: true}\n"
    "post: {compose: separate}\n"
    "systems:\n"
    "  fire:\n"
    "    emit: {rate: 100, life: 1 s, speed: 1 m/s, from: {point: {origin: [0, 1, 0]}}}\n"
    "    look: {atlas: 'builtin:fire', blend: add, size: 0.7 m, temperature: 1800, bloom: 1}\n";

static const char *const ON_DEVICE[] = {"simulate=inplace"};

/* Says what a job's progress callback, render_beside, does after each frame. */
struct caller {
    struct kiln_device *device; /* the device that it renders on; NULL: it opens another */
    bool stays_away;            /* true: it renders nothing */
    int calls;                  /* number of calls so far */
};

/* A progress callback that renders the scene FIRE between two frames of the job. */
static void render_beside(void *user, const struct kiln_progress *progress)
{
    struct caller *caller = user;
    (void)progress;
    caller->calls++;
    if (caller->stays_away)
        return;
    struct kiln_error error = {0};
    struct kiln_device_params params = kiln_device_defaults();
    params.wanted = getenv("KILN_TEST_DEVICE");
    params.gl = true;
    struct kiln_device *own = caller->device ? NULL : kiln_device_open(&params, &error);
    struct kiln_scene *scene = load_scene(FIRE, NULL);
    struct kiln_render_params job = kiln_render_defaults();
    job.techniques = ON_DEVICE;
    job.technique_count = 1;
    if (!kiln_render(own ? own : caller->device, scene, &job, NULL, &error))
        fail_msg("%s", error.message);
    kiln_scene_destroy(&scene);
    kiln_device_close(&own);
}

static bool never(void *user)
{
    (void)user;
    return false;
}

/* Renders SMOKE into EXR files, one a frame, in a folder; `caller` says what its progress callback
 * renders meanwhile. */
static void render_smoke(struct kiln_device *device, struct caller *caller, const char *folder)
{
    char path[160];
    snprintf(path, sizeof path, "%s/x_#.exr", folder);
    struct kiln_error error = {0};
    struct kiln_scene *scene = load_scene(SMOKE, NULL);
    struct kiln_render_params job = kiln_render_defaults();
    job.output = path;
    job.techniques = ON_DEVICE;
    job.technique_count = 1;
    job.progress = render_beside;
    job.stop = never;
    job.user = caller;
    if (!kiln_render(device, scene, &job, NULL, &error))
        fail_msg("%s", error.message);
    assert_int_equal(caller->calls, FRAMES);
    kiln_scene_destroy(&scene);
}

static size_t read_frame(const char *folder, int frame, char *bytes, size_t size)
{
    char path[160];
    snprintf(path, sizeof path, "%s/x_%d.exr", folder, frame);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t length = fread(bytes, 1, size, file);
    fclose(file);
    assert_true(length > 0 && length < size);
    return length;
}

/* A job's frames have the same bytes whether or not the thread renders another job between them, on
 * the same device or on another device. */
static void jobs_do_not_disturb_each_other(void **state)
{
    struct caller callers[] = {{.stays_away = true}, {.device = *state}, {.device = NULL}};
    enum { JOBS = sizeof callers / sizeof *callers, MOST = 1 << 18 };
    char folders[JOBS][32];
    for (int i = 0; i < JOBS; i++) {
        test_make_folder(folders[i]);
        render_smoke(*state, &callers[i], folders[i]);
    }
    char *alone = malloc(MOST), *beside = malloc(MOST);
    assert_true(alone && beside);
    for (int frame = 0; frame < FRAMES; frame++) {
        size_t length = read_frame(folders[0], frame, alone, MOST);
        for (int i = 1; i < JOBS; i++) {
            assert_int_equal(read_frame(folders[i], frame, beside, MOST), length);
            assert_memory_equal(alone, beside, length);
        }
    }
    free(alone);
    free(beside);
    for (int i = 0; i < JOBS; i++)
        test_remove_folder(folders[i]);
}

/* A scene that needs larger textures or storage blocks than the device allows is an error, whose
 * message says what is too large. */
static void exceeded_device_limits_are_errors(void **state)
{
    struct kiln_device *device = *state;
    const struct kiln_device_info info = device->info;
    struct kiln_scene *scene = load_scene(SMOKE, NULL);
    struct kiln_error error = {0};
    device->info.max_texture_size = 32;
    assert_false(kiln_render(device, scene, NULL, NULL, &error));
    expect_error(&error, KILN_DEVICE_FAILED,
                 "output.size: found 64 x 48 pixels; %s draws up to 32 a side", info.name);
    device->info = info;
    device->info.software = false;
    device->info.max_storage_block_bytes = 32;
    assert_false(kiln_render(device, scene, NULL, NULL, &error));
    expect_error(&error, KILN_DEVICE_FAILED,
                 "systems: found up to 20 particles at once; %s draws up to 1", info.name);
    device->info = info;
    kiln_scene_destroy(&scene);
}

/* Stops a job after a number of frames. */
struct stopper {
    uint32_t done, after; /* frames that are done; number of frames after which to stop */
};

static void count_frame(void *user, const struct kiln_progress *progress)
{
    ((struct stopper *)user)->done = progress->done;
}

static bool is_enough(void *user)
{
    const struct stopper *stopper = user;
    return stopper->done == stopper->after;
}

/* A callback can stop a clip after any frame, even after the last, before the file is complete. A
 * stopped clip leaves no file. */
static void clips_stop_until_they_are_complete(void **state)
{
    struct kiln_scene *scene = load_scene(SMOKE, NULL);
    for (uint32_t after = 0; after <= FRAMES; after++) {
        char folder[32], path[64];
        test_make_folder(folder);
        snprintf(path, sizeof path, "%s/clip.gif", folder);
        struct stopper stopper = {.after = after};
        struct kiln_error error = {0};
        struct kiln_render_params job = kiln_render_defaults();
        job.output = path;
        job.progress = count_frame;
        job.stop = is_enough;
        job.user = &stopper;
        assert_false(kiln_render(*state, scene, &job, NULL, &error));
        expect_error(&error, KILN_INTERRUPTED, "stopped");
        assert_int_equal(stopper.done, after);
        assert_int_equal(test_count_files(folder), 0);
        test_remove_folder(folder);
    }
    kiln_scene_destroy(&scene);
}

/* A scene in which a camera circles dark and light smoke. The depth order of the particles changes
 * in every frame, so a sort that is spread over frames always lags behind. */
static const char ORBIT[] =
    "kiln: 1\n"
    "output: {size: [48, 32], fps: 30, frames: 16}\n"
    "simulation: {warmup: 1 s}\n"
    "camera: {target: [0, 1, 0], shutter: {samples: 2},\n"
    "  position: {keys: {0 s: [4, 1, 0], 0.2 s: [0, 1, 4], 0.4 s: [-4, 1, 0], 0.6 s: [0, 1, "
    "-4]}}}\n"
    "systems:\n"
    "  dark:\n"
    "    emit: {rate: 300, life: [0.3 s, 1 s], speed: 1 m/s, from: {sphere: {origin: [0, 1, 0]}}}\n"
    "    look: {atlas: 'builtin:smoke', size: 0.8 m, opacity: 0.9, color: 0.01, lit: 0}\n"
    "  light:\n"
    "    emit: {rate: 300, life: [0.3 s, 1 s], speed: 1 m/s, from: {sphere: {origin: [0, 1, 0]}}}\n"
    "    look: {atlas: 'builtin:smoke', size: 0.8 m, opacity: 0.9, color: 0.9, lit: 0}\n";

enum { ORBIT_FRAMES = 16, ORBIT_BYTES = 48 * 32 * 4 };

/* A callback that copies the picture of a frame into the array of all pictures of the clip. */
static void keep_picture(void *user, const struct kiln_frame_layer *layer)
{
    memcpy((uint8_t *)user + (size_t)layer->frame * ORBIT_BYTES, layer->pixels, ORBIT_BYTES);
}

static void render_orbit(struct kiln_device *device, const char *sort,
                         const struct kiln_frame_range *ranges, size_t range_count,
                         uint8_t *pictures)
{
    struct kiln_error error = {0};
    struct kiln_scene *scene = load_scene(ORBIT, NULL);
    struct kiln_render_params job = kiln_render_defaults();
    job.ranges = ranges;
    job.range_count = range_count;
    job.techniques = &sort;
    job.technique_count = 1;
    job.picture = keep_picture;
    job.user = pictures;
    if (!kiln_render(device, scene, &job, NULL, &error))
        fail_msg("%s", error.message);
    kiln_scene_destroy(&scene);
}

/* A sort that is spread over frames also advances in frames that are not drawn, so a frame has the
 * same pixels whichever earlier frames are left out. They differ from the pixels of an exact
 * sort. */
static void a_spread_sort_follows_undrawn_frames(void **state)
{
    struct kiln_device *device = *state;
    if (!device->info.exact)
        skip();
    static uint8_t whole[ORBIT_FRAMES * ORBIT_BYTES], part[ORBIT_FRAMES * ORBIT_BYTES],
        exact[ORBIT_FRAMES * ORBIT_BYTES];
    static const struct kiln_frame_range some[] = {{3, 4}, {9, 9}, {12, 15}};
    render_orbit(device, "sort=oddeven:5", NULL, 0, whole);
    render_orbit(device, "sort=oddeven:5", some, 3, part);
    render_orbit(device, "sort=cpu", NULL, 0, exact);
    for (size_t i = 0; i < sizeof some / sizeof *some; i++)
        for (uint32_t frame = some[i].first; frame <= some[i].last; frame++)
            assert_memory_equal(whole + frame * ORBIT_BYTES, part + frame * ORBIT_BYTES,
                                ORBIT_BYTES);
    assert_memory_not_equal(whole + 9 * ORBIT_BYTES, exact + 9 * ORBIT_BYTES, ORBIT_BYTES);
    /* A sort that is spread over a single frame is complete, so it gives the pixels of an exact
     * sort. */
    render_orbit(device, "sort=oddeven:1", some, 3, part);
    assert_memory_equal(part + 9 * ORBIT_BYTES, exact + 9 * ORBIT_BYTES, ORBIT_BYTES);
}

static struct kiln_job *make_job(struct kiln_device *device, const struct kiln_scene *scene,
                                 struct kiln_render_params *params, const char *const *technique)
{
    struct kiln_error error = {0};
    *params = kiln_render_defaults();
    params->techniques = technique;
    params->technique_count = 1;
    params->state_hash = true;
    struct kiln_job *job = kiln_job_create(device, scene, params, &error);
    if (!job)
        fail_msg("%s", error.message);
    return job;
}

/* Jobs with different simulation techniques, which start from copies of each other's particles,
 * have the same state in every frame. Their last state is that of a job that runs from the
 * start. */
static void jobs_go_on_from_each_other(void **state)
{
    static const char *const flags[] = {"simulate=cpu", "simulate=inplace", "simulate=pingpong",
                                        "simulate=feedback"};
    enum { JOBS = sizeof flags / sizeof *flags };
    struct kiln_scene *scene = load_scene(SMOKE, NULL);
    struct kiln_error error = {0};
    struct kiln_render_params params[JOBS];
    struct kiln_job *jobs[JOBS];
    for (int i = 0; i < JOBS; i++) {
        jobs[i] = make_job(*state, scene, &params[i], &flags[i]);
        bool ok = i == 0 ? kiln_loop_advance(kiln_job_loop(jobs[0]), 2, &error)
                         : kiln_loop_copy_state(kiln_job_loop(jobs[i]), kiln_job_loop(jobs[i - 1]),
                                                &error);
        if (!ok)
            fail_msg("%s", error.message);
    }
    struct kiln_state_hash before = {{0}};
    for (uint32_t frame = 2; frame < FRAMES; frame++) {
        for (int i = 0; i < JOBS; i++) {
            if (!kiln_job_draw(jobs[i], frame, &error))
                fail_msg("%s", error.message);
            const struct kiln_progress *progress = kiln_job_progress(jobs[i]);
            assert_int_equal(progress->frame, frame);
            assert_true(progress->alive > 0);
            assert_memory_equal(&progress->state, &kiln_job_progress(jobs[0])->state,
                                sizeof progress->state);
        }
        assert_memory_not_equal(&kiln_job_progress(jobs[0])->state, &before, sizeof before);
        before = kiln_job_progress(jobs[0])->state;
    }
    struct kiln_render_stats whole = kiln_render_stats_empty(), stats;
    assert_true(kiln_render(*state, scene, &params[0], &whole, &error));
    for (int i = 0; i < JOBS; i++) {
        assert_true(kiln_job_finish(jobs[i], &stats, &error));
        assert_memory_equal(&stats.state, &whole.state, sizeof whole.state);
        assert_int_equal(stats.frames, 2);
        kiln_job_destroy(&jobs[i]);
    }
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(jobs_do_not_disturb_each_other),
        test_on_device(exceeded_device_limits_are_errors),
        test_on_device(clips_stop_until_they_are_complete),
        test_on_device(a_spread_sort_follows_undrawn_frames),
        test_on_device(jobs_go_on_from_each_other),
    };
    return cmocka_run_group_tests_name("frame", tests, test_device_open, test_device_close);
}
