/* Runs the suite `threads` of `kiln bench`. It draws frames to PNG at two sizes with several
 * numbers of threads, and measures how much of the CPU time of a frame is serial: spent by the
 * thread that draws, outside of loops that several workers can share. The encoders of the files
 * work beside that thread, so their time counts for the frame and is not serial. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "bench/process.h"
#include "bench/suite.h"
#include "gpu/timer.h"
#include "job/job.h"
#include "scene/work.h"

#define CLOUD           "bench/cloud.yaml"
#define CLOUD_PARTICLES 160000

static const struct {
    uint32_t width, height;
} SIZES[] = {{1280, 720}, {3840, 2160}};

static const uint32_t THREAD_COUNTS[] = {1, 2, 8};
enum {
    SIZE_COUNT = sizeof SIZES / sizeof *SIZES,
    COUNT_COUNT = sizeof THREAD_COUNTS / sizeof *THREAD_COUNTS
};

struct thread_bench {
    const struct kiln_bench_run *run;
    const struct kiln_scene *scene;
    char folder[KILN_PATH_SIZE];   /* of the pictures */
    struct kiln_frame_range warm;  /* the frame that warms up */
    struct kiln_frame_range range; /* the frames that are measured */
    struct kiln_job *start_job;    /* a job at the first frame, which others copy */
};

/* CPU time of a frame, ms. */
struct frame_cost {
    double all, serial, passes[KILN_PASS_COUNT]; /* serial time of each pass */
};

static bool create_job(const struct thread_bench *b, uint32_t threads, const char *output,
                       struct kiln_lane_flags *flags, struct kiln_render_params *params,
                       struct kiln_job **job, struct kiln_error *error)
{
    static const struct kiln_lane automatic = {.name = "auto", .techniques = ""};
    *params = kiln_lane_params(b->run, &automatic, flags, output ? &b->range : &b->warm);
    params->threads = threads;
    params->output = output;
    *job = kiln_job_create(b->run->device, b->scene, params, error);
    return *job != NULL;
}

/* Draws a frame that is not measured: the first one makes pictures that later frames reuse. */
static bool warm_up(const struct thread_bench *b, struct kiln_job *job, struct kiln_error *error)
{
    struct kiln_drawn drawn;
    if (!kiln_loop_draw(kiln_job_loop(job), b->warm.first, false, &drawn, error))
        return false;
    kiln_picture_destroy(&drawn.picture);
    return true;
}

static bool draw_frames(const struct thread_bench *b, struct kiln_job *job, struct frame_cost *cost,
                        struct kiln_error *error)
{
    struct kiln_timer *timer = kiln_loop_timer(kiln_job_loop(job));
    struct kiln_threads *threads = kiln_loop_threads(kiln_job_loop(job));
    kiln_timer_measure_serial(timer, threads);
    kiln_timer_collect_serial(timer, cost->passes);
    const double start_cpu_s = kiln_clock_cpu_seconds();
    const double start_serial_s = kiln_threads_serial_seconds(threads);
    for (uint32_t frame = b->range.first; frame <= b->range.last; frame++) {
        if (!kiln_job_draw(job, frame, error))
            return false;
    }
    const double to_ms = 1e3 / (b->range.last - b->range.first + 1);
    cost->serial = to_ms * (kiln_threads_serial_seconds(threads) - start_serial_s);
    struct kiln_render_stats stats;
    if (!kiln_job_finish(job, &stats, error))
        return false;
    cost->all = to_ms * (kiln_clock_cpu_seconds() - start_cpu_s);
    kiln_timer_collect_serial(timer, cost->passes);
    for (int pass = 0; pass < KILN_PASS_COUNT; pass++)
        cost->passes[pass] *= 1e-3 * to_ms;
    return true;
}

static bool measure(const struct thread_bench *b, uint32_t threads, struct frame_cost *cost,
                    struct kiln_error *error)
{
    struct kiln_lane_flags flags;
    struct kiln_render_params params;
    struct kiln_job *job = NULL;
    char path[KILN_PATH_SIZE];
    const bool ok = kiln_path_join(path, b->folder, "frame_%08d.png", error) &&
                    create_job(b, threads, path, &flags, &params, &job, error) &&
                    kiln_loop_copy_state(kiln_job_loop(job), kiln_job_loop(b->start_job), error) &&
                    warm_up(b, job, error) && draw_frames(b, job, cost, error);
    kiln_job_destroy(&job);
    return ok;
}

/* ---- Rows ------------------------------------------------------------------------------------ */

static bool add_row(const struct thread_bench *b, uint32_t threads, const char *measure,
                    const char *kind, double value, struct kiln_error *error)
{
    const struct kiln_bench_row row = {
        .x = threads, .measure = measure, .technique = kind, .spread = kiln_spread_of(&value, 1)};
    return kiln_bench_add_row(b->run->bench, &row, error);
}

static bool add_rows(const struct thread_bench *b, uint32_t threads, const struct frame_cost *cost,
                     struct kiln_error *error)
{
    double between = cost->serial;
    if (!add_row(b, threads, "frame", "all, ms", cost->all, error) ||
        !add_row(b, threads, "frame", "serial, ms", cost->serial, error) ||
        !add_row(b, threads, "frame", "serial, %", 1e2 * cost->serial / cost->all, error))
        return false;
    for (int pass = 0; pass < KILN_PASS_output; pass++) { /* `output` is no pass of the timer */
        between -= cost->passes[pass];
        if (!add_row(b, threads, kiln_pass_name((enum kiln_pass)pass), "serial, ms",
                     cost->passes[pass], error))
            return false;
    }
    return add_row(b, threads, "between passes", "serial, ms", between, error);
}

static bool begin_part(const struct thread_bench *b, const char *name, struct kiln_error *error)
{
    const struct kiln_scene_info info = kiln_scene_facts(b->scene);
    const char *part_name = kiln_arena_format(b->run->bench->arena, "threads, %s, %ux%u", name,
                                              info.width, info.height);
    if (!part_name)
        return kiln_error_no_memory(error, "measurements");
    const struct kiln_bench_part part = {
        .name = part_name,
        .title = "CPU time of a frame with its PNG, and what of it is serial",
        .sweep = "threads",
        .unit = "ms; %",
    };
    return kiln_bench_begin(b->run, &part, error) &&
           kiln_bench_add_note(b->run->bench, error, "Means of frames %u to %u.", b->range.first,
                               b->range.last);
}

/* ---- Scenes ---------------------------------------------------------------------------------- */

/* Brings a job to the frame that warms up, and finds from its time how many frames are measured. */
static bool choose_frames(struct thread_bench *b, struct kiln_lane_flags *flags,
                          struct kiln_render_params *params, struct kiln_error *error)
{
    const double seconds = b->run->params->quick ? 0.0 : b->run->params->seconds;
    if (!create_job(b, 0, NULL, flags, params, &b->start_job, error) ||
        !kiln_loop_advance(kiln_job_loop(b->start_job), b->warm.first, error) ||
        !warm_up(b, b->start_job, error))
        return false;
    const double start_s = kiln_clock_seconds();
    if (!warm_up(b, b->start_job, error))
        return false;
    const double frames = seconds / (kiln_clock_seconds() - start_s + 1e-6);
    const uint32_t most = b->run->bench->repetitions, least = KILN_BENCH_MIN_REPETITIONS;
    const uint32_t count = frames < least ? least : frames > most ? most : (uint32_t)frames;
    b->range = (struct kiln_frame_range){b->warm.first + 1, b->warm.first + count};
    return true;
}

static bool measure_scene(struct thread_bench *b, const char *name, size_t size,
                          struct kiln_error *error)
{
    struct kiln_lane_flags flags;
    struct kiln_render_params params;
    bool ok = choose_frames(b, &flags, &params, error) && begin_part(b, name, error);
    for (size_t i = 0; ok && i < COUNT_COUNT; i++) {
        struct frame_cost cost = {0};
        kiln_bench_say(b->run, "%s, %ux%u, %u threads", name, SIZES[size].width, SIZES[size].height,
                       THREAD_COUNTS[i]);
        ok = measure(b, THREAD_COUNTS[i], &cost, error) &&
             add_rows(b, THREAD_COUNTS[i], &cost, error);
    }
    kiln_job_destroy(&b->start_job);
    return ok;
}

/* Loads a scene of the caller, or for NULL the library's cloud, at one of the sizes. */
static struct kiln_scene *load(const struct kiln_bench_run *run, const char *path, size_t size,
                               uint32_t *frame, struct kiln_error *error)
{
    struct kiln_settings settings = {.count = 0};
    kiln_set_picture(run, &settings, SIZES[size].width, SIZES[size].height);
    if (!path) {
        kiln_set_number(run, &settings, "systems.*.emit.rate", CLOUD_PARTICLES / 2);
        *frame = 0;
        return kiln_bench_load_scene(run, CLOUD, &settings, error);
    }
    struct kiln_scene_params params = run->params->scene;
    const char **overrides = calloc(params.override_count + 1, sizeof *overrides);
    struct kiln_scene *scene = NULL;
    if (overrides && settings.items[0]) {
        if (params.override_count > 0)
            memcpy(overrides, params.overrides, params.override_count * sizeof *overrides);
        overrides[params.override_count++] = settings.items[0];
        params.overrides = overrides;
        scene = kiln_bench_load_caller_scene(run, path, &params, frame, error);
    } else {
        kiln_error_no_memory(error, "measurements");
    }
    free(overrides);
    return scene;
}

static bool run_scene(const struct kiln_bench_run *run, const char *path, struct kiln_error *error)
{
    struct thread_bench b = {.run = run};
    bool ok = true;
    if (!kiln_path_join(b.folder, run->params->scratch, "kiln-bench-XXXXXX", error))
        return false;
    if (!mkdtemp(b.folder))
        return kiln_error_set(error, KILN_IO, "%s: no folder for pictures can be made there",
                              run->params->scratch);
    for (size_t size = 0; ok && size < (run->params->quick ? 1 : SIZE_COUNT); size++) {
        struct kiln_scene *scene = load(run, path, size, &b.warm.first, error);
        b.scene = scene;
        b.warm.last = b.warm.first;
        ok = scene && measure_scene(&b, path ? path : CLOUD, size, error);
        kiln_scene_destroy(&scene);
    }
    kiln_process_remove_folder(b.folder);
    return ok;
}

bool kiln_suite_threads(const struct kiln_bench_run *run, struct kiln_error *error)
{
    bool ok = run->params->scene_count > 0 || run_scene(run, NULL, error);
    for (size_t i = 0; ok && i < run->params->scene_count; i++)
        ok = run_scene(run, run->params->scenes[i], error);
    return ok;
}
