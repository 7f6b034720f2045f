/* Runs the suite `jobs` of `kiln bench`, which measures a clip rendered in parts against one run of
 * the whole clip. Each part is rendered by a job of its own that starts from a saved state. The
 * results say what the parts cost beyond the run, in which stages, and how long the clip takes on
 * many machines. Every job is a process of kiln, since starting one is part of its cost. Jobs run
 * one after the other; machines that work at the same time are simulated. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/embedded.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/temporary.h"
#include "bench/process.h"
#include "bench/schedule.h"
#include "bench/suite.h"
#include "job/shard.h"
#include "job/states.h"
#include "scene/work.h"

enum { PARTS = 64, QUICK_PARTS = 2, OWN_ARGUMENTS = 16 };

static const char SCENE[] = "fire_beam.yaml"; /* a scene of the library */

/* The values that one turn measures: whole commands, and the stages of all parts together. */
enum value {
    SINGLE,
    BAKE,
    ALL_PARTS,
    JOIN,
    START,  /* until a device is open: the program, its libraries, the scene */
    SET_UP, /* from there until the first frame is drawn: atlases, the state, the frame */
    LOAD,   /* the part of SET_UP that loads the state */
    FRAMES, /* the other frames, and encoding that runs beside them */
    END,    /* from the last frame on: the encoder's last frames, the file */
    VALUES
};

struct clip_bench {
    const struct kiln_bench_run *run;
    struct kiln_scene *scene; /* the clip of all parts */
    const char *name, *path;  /* the scene's name in messages, and its file */
    const char **options;     /* options of all jobs that read the scene */
    size_t option_count;
    uint32_t parts, part_frames, turns;
    char folder[KILN_PATH_SIZE];
    const char *work, *single, *clip, *states; /* paths below `folder`; `work` is a turn's folder */
    double cpu_s[VALUES][KILN_BENCH_MAX_REPETITIONS];
    double elapsed_s[START][KILN_BENCH_MAX_REPETITIONS]; /* of ALL_PARTS, the longest part's */
    double *part_s;                                      /* elapsed: [turn * parts + part] */
};

static bool no_memory(struct kiln_error *error)
{
    return kiln_error_no_memory(error, "measurements");
}

/* ---- Jobs ------------------------------------------------------------------------------------ */

/* Runs kiln COMMAND --quiet OWN... [OPTIONS...] -- OPERAND. Only jobs that read the scene get the
 * options. */
static bool run_kiln(const struct clip_bench *b, const char *command, const char *const *own,
                     const char *operand, struct kiln_process *process, struct kiln_error *error)
{
    const char **arguments = calloc(b->option_count + OWN_ARGUMENTS, sizeof *arguments);
    size_t count = 0;
    if (!arguments)
        return no_memory(error);
    arguments[count++] = command;
    arguments[count++] = "--quiet";
    while (*own)
        arguments[count++] = *own++;
    for (size_t i = 0; i < b->option_count && operand == b->path; i++)
        arguments[count++] = b->options[i];
    arguments[count++] = "--";
    arguments[count] = operand;
    const bool ok = kiln_process_run(b->run, arguments, process, error);
    free(arguments);
    return ok;
}

static bool run_whole(struct clip_bench *b, enum value value, uint32_t turn, const char *command,
                      const char *const *own, const char *operand, struct kiln_error *error)
{
    struct kiln_process process = {.reports_events = false};
    if (!run_kiln(b, command, own, operand, &process, error))
        return false;
    b->cpu_s[value][turn] = process.cpu_s[KILN_PROCESS_END];
    b->elapsed_s[value][turn] = process.elapsed_s;
    return true;
}

static bool run_part(struct clip_bench *b, uint32_t part, uint32_t turn, struct kiln_error *error)
{
    char shard[64];
    snprintf(shard, sizeof shard, "--shard=%u/%u", part + 1, b->parts);
    struct kiln_process process = {.reports_events = true};
    if (!run_kiln(b, "render",
                  (const char *const[]){"-o", b->clip, "--states", b->states, shard, NULL}, b->path,
                  &process, error))
        return false;
    const double *cpu_s = process.cpu_s;
    b->cpu_s[ALL_PARTS][turn] += cpu_s[KILN_PROCESS_END];
    b->cpu_s[START][turn] += cpu_s[KILN_PROCESS_DEVICE];
    b->cpu_s[SET_UP][turn] += cpu_s[KILN_PROCESS_FIRST] - cpu_s[KILN_PROCESS_DEVICE];
    b->cpu_s[FRAMES][turn] += cpu_s[KILN_PROCESS_LAST] - cpu_s[KILN_PROCESS_FIRST];
    b->cpu_s[END][turn] += cpu_s[KILN_PROCESS_END] - cpu_s[KILN_PROCESS_LAST];
    b->part_s[turn * b->parts + part] = process.elapsed_s;
    if (b->elapsed_s[ALL_PARTS][turn] < process.elapsed_s)
        b->elapsed_s[ALL_PARTS][turn] = process.elapsed_s;
    return true;
}

/* Loads all states in this process, as each part loads its own, and measures the CPU time of
 * that. */
static bool load_states(struct clip_bench *b, uint32_t turn, struct kiln_error *error)
{
    const struct kiln_bench_params *params = b->run->params;
    const struct kiln_loop_params settings = {.techniques = params->techniques,
                                              .technique_count = params->technique_count,
                                              .threads = params->threads,
                                              .log = params->log};
    const struct kiln_output_needs needs = {.bits = 8};
    struct kiln_loop *loop = kiln_loop_create(b->run->device, b->scene, &settings, error);
    struct kiln_states *states =
        loop
            ? kiln_states_open(b->states, b->scene, kiln_loop_techniques(loop), &params->log, error)
            : NULL;
    bool ok = states && kiln_loop_set_up(loop, needs, error);
    const double start_s = kiln_clock_cpu_seconds();
    for (uint32_t part = 0; part < b->parts && ok; part++)
        ok = kiln_states_take_up(states, loop, part * b->part_frames, error);
    b->cpu_s[LOAD][turn] = kiln_clock_cpu_seconds() - start_s;
    kiln_states_close(&states);
    kiln_loop_destroy(&loop);
    return ok;
}

/* Fails unless the joined clip has the bytes of the single run's. */
static bool compare_clips(const struct clip_bench *b, struct kiln_error *error)
{
    char single[65], clip[65];
    if (!kiln_hash_sha256_file(b->single, single) || !kiln_hash_sha256_file(b->clip, clip))
        return kiln_error_set_errno(error, KILN_IO, errno, "%s: a clip cannot be read", b->work);
    return strcmp(single, clip) == 0 ||
           kiln_error_set(error, KILN_FRAME_FAILED,
                          "%s: the clip of %u parts has other bytes than the clip of one run",
                          b->name, b->parts);
}

/* ---- Turns ----------------------------------------------------------------------------------- */

static bool take_turn(struct clip_bench *b, uint32_t turn, struct kiln_error *error)
{
    kiln_bench_say(b->run, "turn %u: single run", turn + 1);
    if (!run_whole(b, SINGLE, turn, "render", (const char *const[]){"-o", b->single, NULL}, b->path,
                   error))
        return false;
    kiln_bench_say(b->run, "turn %u: bake, and %u parts", turn + 1, b->parts);
    if (!run_whole(b, BAKE, turn, "bake", (const char *const[]){"-o", b->states, NULL}, b->path,
                   error))
        return false;
    for (uint32_t part = 0; part < b->parts; part++) {
        if (!run_part(b, part, turn, error))
            return false;
    }
    return run_whole(b, JOIN, turn, "join", (const char *const[]){NULL}, b->clip, error) &&
           compare_clips(b, error) && load_states(b, turn, error);
}

/* Draws a frame, so that atlases of particles are in the cache, and programs in memory. */
static bool warm_up(struct clip_bench *b, struct kiln_error *error)
{
    struct kiln_process process = {.reports_events = false};
    kiln_bench_say(b->run, "warming up");
    return run_kiln(b, "render",
                    (const char *const[]){"-o", b->single, "--force", "--frames=0", NULL}, b->path,
                    &process, error);
}

static bool take_turns(struct clip_bench *b, struct kiln_error *error)
{
    const double start_s = kiln_clock_seconds();
    bool ok = warm_up(b, error);
    kiln_process_remove_folder(b->work);
    for (uint32_t turn = 0; turn < b->run->bench->repetitions && ok; turn++) {
        if (turn >= KILN_BENCH_MIN_REPETITIONS &&
            kiln_clock_seconds() - start_s > b->run->params->seconds)
            break;
        ok = take_turn(b, turn, error);
        kiln_process_remove_folder(b->work);
        b->turns = turn + 1;
    }
    return ok;
}

/* ---- Results --------------------------------------------------------------------------------- */

static bool add_row(const struct clip_bench *b, double x, const char *measure,
                    const char *technique, const double *values, struct kiln_error *error)
{
    const struct kiln_bench_row row = {.x = x,
                                       .measure = measure,
                                       .technique = technique,
                                       .spread = kiln_spread_of(values, b->turns)};
    return kiln_bench_add_row(b->run->bench, &row, error);
}

static bool add_costs(const struct clip_bench *b, struct kiln_error *error)
{
    static const struct {
        const char *measure, *technique;
    } names[VALUES] = {
        [SINGLE] = {"all", "single run"}, [BAKE] = {"all", "bake"},
        [ALL_PARTS] = {"all", "parts"},   [JOIN] = {"all", "join"},
        [START] = {"start", "parts"},     [SET_UP] = {"first frame", "parts"},
        [LOAD] = {"state", "parts"},      [FRAMES] = {"other frames", "parts"},
        [END] = {"end", "parts"},
    };
    const struct kiln_scene_info info = kiln_scene_facts(b->scene);
    const struct kiln_bench_part part = {
        .name = "jobs",
        .title = "A clip by one run, and by parts that start from saved states: processor time",
        .sweep = "parts",
        .unit = "s",
    };
    if (!kiln_bench_begin(b->run, &part, error))
        return false;
    for (int i = 0; i < VALUES; i++) {
        if (!add_row(b, b->parts, names[i].measure, names[i].technique, b->cpu_s[i], error))
            return false;
    }
    return kiln_bench_add_note(b->run->bench, error,
                               "%s, %u x %u pixels, %u frames, %u a part. The joined clip had the "
                               "same bytes as the clip of the single run in all %u turns.",
                               b->name, info.width, info.height, info.frames, b->part_frames,
                               b->turns) &&
           kiln_bench_add_note(
               b->run->bench, error,
               "The stages of all parts: start lasts until a device is open; first frame lasts "
               "from there until the frame is drawn; state is the part of first frame in which the "
               "saved state is checked and loaded; end is everything after the last frame.");
}

static bool add_ratios(const struct clip_bench *b, struct kiln_error *error)
{
    double parts_over_both[KILN_BENCH_MAX_REPETITIONS], with_bake[KILN_BENCH_MAX_REPETITIONS],
        parts_over_single[KILN_BENCH_MAX_REPETITIONS];
    const struct kiln_bench_part part = {
        .name = "jobs_ratio",
        .title = "Processor time by parts, as a multiple of that without",
        .sweep = "parts",
        .unit = "times",
    };
    for (uint32_t i = 0; i < b->turns; i++) {
        const double parts_s = b->cpu_s[ALL_PARTS][i] + b->cpu_s[JOIN][i];
        const double single_s = b->cpu_s[SINGLE][i], bake_s = b->cpu_s[BAKE][i];
        parts_over_both[i] = parts_s / (single_s + bake_s);
        with_bake[i] = (bake_s + parts_s) / (single_s + bake_s);
        parts_over_single[i] = parts_s / single_s;
    }
    return kiln_bench_begin(b->run, &part, error) &&
           add_row(b, b->parts, "parts + join", "single run + bake", parts_over_both, error) &&
           add_row(b, b->parts, "bake + parts + join", "single run + bake", with_bake, error) &&
           add_row(b, b->parts, "parts + join", "single run", parts_over_single, error);
}

/* ---- Many workers ---------------------------------------------------------------------------- */

/* How long a clip takes with a number of workers, for each turn. */
struct prediction {
    double elapsed_s[KILN_BENCH_MAX_REPETITIONS], bound_s[KILN_BENCH_MAX_REPETITIONS];
    double speed_up[KILN_BENCH_MAX_REPETITIONS], efficiency[KILN_BENCH_MAX_REPETITIONS];
};

static struct prediction predict(const struct clip_bench *b, uint32_t workers)
{
    struct prediction o;
    for (uint32_t i = 0; i < b->turns; i++) {
        const double bake_and_join_s = b->elapsed_s[BAKE][i] + b->elapsed_s[JOIN][i];
        o.elapsed_s[i] =
            bake_and_join_s + kiln_schedule_s(b->part_s + (size_t)i * b->parts, b->parts, workers);
        o.bound_s[i] = bake_and_join_s + b->elapsed_s[ALL_PARTS][i];
        o.speed_up[i] = b->elapsed_s[SINGLE][i] / o.elapsed_s[i];
        o.efficiency[i] = 100.0 * o.speed_up[i] / workers;
    }
    return o;
}

/* Returns the next number of workers: 1, 2, 4, ..., 512, 1000. */
static uint32_t next_workers(uint32_t workers)
{
    return workers < KILN_MAX_WORKERS / 2 ? 2 * workers
           : workers < KILN_MAX_WORKERS   ? KILN_MAX_WORKERS
                                          : UINT32_MAX;
}

/* Notes which part is the longest, by the medians of the turns. */
static bool name_longest(const struct clip_bench *b, struct kiln_error *error)
{
    uint32_t longest = 0;
    double most_s = 0.0;
    for (uint32_t part = 0; part < b->parts; part++) {
        double values[KILN_BENCH_MAX_REPETITIONS];
        for (uint32_t i = 0; i < b->turns; i++)
            values[i] = b->part_s[i * b->parts + part];
        const double median_s = kiln_spread_of(values, b->turns).median;
        longest = median_s > most_s ? part : longest;
        most_s = median_s > most_s ? median_s : most_s;
    }
    const struct kiln_frame_range frames =
        kiln_parts_frames(longest, longest + 1, b->part_frames, b->parts * b->part_frames);
    return kiln_bench_add_note(
        b->run->bench, error,
        "Simulated from measured times: the bake comes first, then the parts in their order, each "
        "on the first free worker, then the join. A worker is a machine like this one. The bound "
        "is the bake (%.3f s), the longest part and the join (%.3f s). The longest part is part "
        "%u, frames %u-%u: %.3f s.",
        kiln_spread_of(b->elapsed_s[BAKE], b->turns).median,
        kiln_spread_of(b->elapsed_s[JOIN], b->turns).median, longest + 1, frames.first, frames.last,
        most_s);
}

static bool add_outlook(const struct clip_bench *b, struct kiln_error *error)
{
    const struct kiln_bench_part elapsed = {
        .name = "jobs_elapsed",
        .title = "The same clip on many workers: elapsed time, simulated from measured parts",
        .sweep = "workers",
        .unit = "s",
        .plotted = true,
    };
    const struct kiln_bench_part gain = {
        .name = "jobs_speedup",
        .title = "Speed-up compared with the single run, and speed-up for each worker",
        .sweep = "workers",
        .unit = "times; %",
    };
    if (!kiln_bench_begin(b->run, &elapsed, error) ||
        !add_row(b, 1, "elapsed", "single run", b->elapsed_s[SINGLE], error))
        return false;
    for (uint32_t n = 1; n <= KILN_MAX_WORKERS; n = next_workers(n)) {
        const struct prediction o = predict(b, n);
        if (!add_row(b, n, "elapsed", "parts", o.elapsed_s, error) ||
            !add_row(b, n, "elapsed", "bound", o.bound_s, error))
            return false;
    }
    if (!name_longest(b, error) || !kiln_bench_begin(b->run, &gain, error))
        return false;
    for (uint32_t n = 1; n <= KILN_MAX_WORKERS; n = next_workers(n)) {
        const struct prediction o = predict(b, n);
        if (!add_row(b, n, "speed-up", "times", o.speed_up, error) ||
            !add_row(b, n, "efficiency", "%", o.efficiency, error))
            return false;
    }
    return true;
}

/* ---- The clip -------------------------------------------------------------------------------- */

static struct kiln_settings default_settings(const struct kiln_bench_run *run)
{
    struct kiln_settings settings = {.count = 0};
    kiln_set_picture(run, &settings, 320, 180);
    if (run->params->quick) {
        kiln_set(run, &settings, "systems.*.look.atlas=builtin:spark");
        kiln_set(run, &settings, "output.fps=5");
    }
    return settings;
}

static struct kiln_scene *load(const struct clip_bench *b, const char *const *overrides,
                               size_t count, struct kiln_error *error)
{
    struct kiln_scene_params params = b->run->params->scene;
    params.overrides = overrides;
    params.override_count = count;
    return kiln_scene_load(b->path, &params, error);
}

/* Finds how many frames a part has, and loads the clip of all parts. `overrides` has room for one
 * more. */
static bool load_clip(struct clip_bench *b, const char **overrides, size_t *count,
                      struct kiln_error *error)
{
    b->scene = load(b, overrides, *count, error);
    if (!b->scene)
        return false;
    const struct kiln_scene_info info = kiln_scene_facts(b->scene);
    b->part_frames = kiln_part_frames(info.fps_num, info.fps_den);
    overrides[*count] = kiln_arena_format(b->run->bench->arena, "output.frames=%llu",
                                          (unsigned long long)b->parts * b->part_frames);
    if (!overrides[(*count)++])
        return no_memory(error);
    kiln_scene_destroy(&b->scene);
    b->scene = load(b, overrides, *count, error);
    return b->scene != NULL;
}

/* Adds an option of all jobs that read the scene, such as "--set=KEY=VALUE". */
static bool add_option(struct clip_bench *b, const char *name, const char *value,
                       struct kiln_error *error)
{
    const char *option = kiln_arena_format(b->run->bench->arena, "--%s=%s", name, value);
    b->options[b->option_count++] = option;
    return option || no_memory(error);
}

static bool make_options(struct clip_bench *b, const char **overrides, size_t count,
                         struct kiln_error *error)
{
    const struct kiln_bench_params *params = b->run->params;
    char threads[16];
    snprintf(threads, sizeof threads, "%u", params->threads);
    b->options = calloc(count + params->technique_count + 3, sizeof *b->options);
    if (!b->options)
        return no_memory(error);
    bool ok = add_option(b, "threads", threads, error);
    if (params->device)
        ok = ok && add_option(b, "device", params->device, error);
    if (params->scene.asset_root)
        ok = ok && add_option(b, "asset-root", params->scene.asset_root, error);
    for (size_t i = 0; i < params->technique_count; i++)
        ok = ok && add_option(b, "technique", params->techniques[i], error);
    for (size_t i = 0; i < count; i++)
        ok = ok && add_option(b, "set", overrides[i], error);
    return ok;
}

/* Opens the scene of the caller as it is, or a small one of the library. The caller's overrides
 * come last. */
static bool open_clip(struct clip_bench *b, struct kiln_error *error)
{
    const struct kiln_bench_params *params = b->run->params;
    const struct kiln_settings settings = default_settings(b->run);
    const bool given = params->scene_count > 0;
    const size_t own = given ? 0 : settings.count;
    const char **overrides = calloc(own + params->scene.override_count + 1, sizeof *overrides);
    if (!overrides)
        return no_memory(error);
    size_t count = 0;
    for (size_t i = 0; i < own; i++)
        overrides[count++] = settings.items[i];
    for (size_t i = 0; i < params->scene.override_count; i++)
        overrides[count++] = params->scene.overrides[i];
    b->path = given ? params->scenes[0]
                    : kiln_arena_format(b->run->bench->arena, "%s/%s", b->folder, SCENE);
    b->name = given ? params->scenes[0] : SCENE;
    const char *text = kiln_embedded_find(kiln_embedded_scenes, SCENE);
    bool ok = b->path || no_memory(error);
    if (ok && !given)
        ok = kiln_temporary_write_file(b->path, text, strlen(text), error);
    ok = ok && load_clip(b, overrides, &count, error) && make_options(b, overrides, count, error);
    free(overrides);
    return ok;
}

static bool name_files(struct clip_bench *b, struct kiln_error *error)
{
    struct kiln_arena *arena = b->run->bench->arena;
    b->work = kiln_arena_format(arena, "%s/turn", b->folder);
    b->single = kiln_arena_format(arena, "%s/turn/single.mp4", b->folder);
    b->clip = kiln_arena_format(arena, "%s/turn/parts.mp4", b->folder);
    b->states = kiln_arena_format(arena, "%s/turn/states", b->folder);
    b->part_s = calloc((size_t)KILN_BENCH_MAX_REPETITIONS * b->parts, sizeof *b->part_s);
    return (b->work && b->single && b->clip && b->states && b->part_s) || no_memory(error);
}

bool kiln_suite_jobs(const struct kiln_bench_run *run, struct kiln_error *error)
{
    const struct kiln_bench_params *params = run->params;
    struct clip_bench b = {.run = run,
                           .parts = params->parts   ? params->parts
                                    : params->quick ? QUICK_PARTS
                                                    : PARTS};
    if (!kiln_path_join(b.folder, params->scratch, "kiln-bench-XXXXXX", error))
        return false;
    if (!mkdtemp(b.folder))
        return kiln_error_set_errno(error, KILN_IO, errno, "%s: no folder can be made there",
                                    params->scratch);
    const bool ok = name_files(&b, error) && open_clip(&b, error) && take_turns(&b, error) &&
                    add_costs(&b, error) && add_ratios(&b, error) && add_outlook(&b, error);
    kiln_process_remove_folder(b.folder);
    kiln_scene_destroy(&b.scene);
    free(b.options);
    free(b.part_s);
    return ok;
}
