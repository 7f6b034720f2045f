/* Runs the suite `gravity` of `kiln bench`: gravity of particles that all attract each other (Drone
 * 2007, 7.4.3). The table in lib/bench/bench.c names kiln_suite_gravity, which is called once a
 * run.
 *
 * The suite has three parts. The first measures pairs of bodies a second, without a scene: the
 * host's loop (sim/crowd/gravity.h) at each width of vectors that the machine has, and the paper's
 * way, which splats forces into a texture (bench/force_splat.h) and needs GL. The second measures
 * whole frames of a scene. The third, in drift.c, measures how well bodies keep their energy.
 *
 * Saved results hold the names of parts and rows. After a change of a name, or of what is measured
 * under it, new results cannot be compared with older ones. */
#include "sim/crowd/gravity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/error.h"
#include "bench/force_splat.h"
#include "bench/suite.h"
#include "shared/random.h"

static const char SCENE[] = "bench/stars.yaml";

/* ---- Pairs ----------------------------------------------------------------------------------- */

enum {
    SPLATS = 2, /* formats of the texture into which forces are splatted */
    /* The ways to compute gravity that are compared: the first KILN_SIMD_COUNT are the widths of
     * vectors, numbered as enum kiln_simd, and the splats follow. */
    WAYS = KILN_SIMD_COUNT + SPLATS,
    TARGETS_AT_A_TIME = 4 * KILN_GRAVITY_BLOCK, /* bodies that a thread takes at a time */
    /* With more bodies than these, llvmpipe would blend for seconds in each turn. */
    MOST_SPLATTED_IN_SOFTWARE = 4096,
};

/* Holds the bodies of one size, and the times that were measured with them. */
struct pull {
    const struct kiln_bench_run *run;
    struct kiln_threads *threads;
    uint32_t count, room; /* bodies; the same rounded up to a multiple of KILN_GRAVITY_BLOCK */
    float4 *sources;
    float3 *accelerations;
    struct kiln_force_splat *splats[SPLATS]; /* NULL: not measured */
    const char *problems[SPLATS];            /* why a splat is not measured */
    struct kiln_samples *samples;            /* [WAYS] */
};

static bool is_splat(size_t way)
{
    return way >= KILN_SIMD_COUNT;
}

static void way_name(size_t way, char name[32])
{
    static const char *const formats[SPLATS] = {"splats, RGBA32F", "splats, RGBA16F"};
    if (is_splat(way))
        snprintf(name, 32, "%s", formats[way - KILN_SIMD_COUNT]);
    else
        snprintf(name, 32, "cpu, %s", kiln_simd_name((enum kiln_simd)way));
}

static bool set_up(struct pull *pull, struct kiln_error *error)
{
    static const GLenum formats[SPLATS] = {GL_RGBA32F, GL_RGBA16F};
    struct kiln_device *device = kiln_device_gl(pull->run->device);
    pull->threads = kiln_threads_create(pull->run->params->threads);
    pull->room = (pull->count + KILN_GRAVITY_BLOCK - 1) / KILN_GRAVITY_BLOCK * KILN_GRAVITY_BLOCK;
    pull->sources = calloc(pull->room, sizeof *pull->sources);
    pull->accelerations = calloc(pull->room, sizeof *pull->accelerations);
    pull->samples = calloc(WAYS, sizeof *pull->samples);
    if (!pull->threads || !pull->sources || !pull->accelerations || !pull->samples)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for measurements");
    for (uint32_t i = 0; i < pull->count; i++) {
        const float3 at = random_in_ball(random_stream(1, i), 0, false);
        pull->sources[i] = FLOAT4(at.x, at.y, at.z, 1e-3f);
    }
    for (int i = 0; i < SPLATS; i++) {
        if (!device)
            pull->problems[i] = "there is no OpenGL";
        else if (device->info.software && pull->count > MOST_SPLATTED_IN_SOFTWARE)
            pull->problems[i] = "the measurement takes seconds on a software device";
        else if (!(pull->splats[i] =
                       kiln_force_splat_create(device, formats[i], pull->count, error)))
            return false;
    }
    return true;
}

static bool run_way(struct pull *pull, size_t way, double *ms, struct kiln_error *error)
{
    const float softening_square = 1e-4f;
    if (is_splat(way))
        return kiln_force_splat_run(pull->splats[way - KILN_SIMD_COUNT], pull->sources, pull->count,
                                    softening_square, ms, error);
    struct kiln_gravity gravity = {.sources = pull->sources,
                                   .count = pull->count,
                                   .places = pull->sources,
                                   .softening_square = softening_square,
                                   .accelerations = pull->accelerations};
    const struct kiln_gravity_loops *loops =
        KILN_SIMD_PICK(kiln_gravity_loops, (enum kiln_simd)way);
    const double before_s = kiln_clock_seconds();
    kiln_threads_for(pull->threads, pull->count, TARGETS_AT_A_TIME, loops->pull, &gravity);
    *ms = 1e3 * (kiln_clock_seconds() - before_s);
    return true;
}

static bool can_run(const struct pull *pull, size_t way)
{
    return is_splat(way) ? pull->splats[way - KILN_SIMD_COUNT] != NULL
                         : kiln_simd_has((enum kiln_simd)way);
}

/* Runs all ways by turns, so that a change of the machine's speed affects them alike. The first
 * turn only warms up. */
static bool take_turns(struct pull *pull, struct kiln_error *error)
{
    const struct kiln_bench_params *params = pull->run->params;
    double spent_ms = 0.0;
    for (uint32_t turn = 0; turn <= pull->run->bench->repetitions; turn++) {
        if (turn > KILN_BENCH_MIN_REPETITIONS && spent_ms > 1e3 * params->seconds)
            return true;
        for (size_t way = 0; way < WAYS; way++) {
            struct kiln_samples *samples = &pull->samples[way];
            double ms = 0.0;
            if (!can_run(pull, way))
                continue;
            if (params->stop && params->stop(params->user))
                return kiln_error_set(error, KILN_INTERRUPTED, "stopped");
            if (!run_way(pull, way, &ms, error))
                return false;
            if (turn > 0)
                samples->ms[KILN_PASS_simulate][samples->count++] = ms;
            spent_ms += turn > 0 ? ms : 0.0;
        }
    }
    return true;
}

/* Adds a row of one way: its times as thousands of millions of pairs a second. A body and itself
 * count as a pair, because the loops compute that pair, too. */
static bool add_row(const struct pull *pull, size_t way, const char *name, struct kiln_error *error)
{
    const double pairs = (double)pull->count * (double)pull->count;
    const size_t reference = KILN_SIMD_NARROWEST;
    const struct kiln_samples *samples = &pull->samples[way];
    const double *ms = samples->ms[KILN_PASS_simulate];
    double values[KILN_BENCH_MAX_REPETITIONS];
    for (uint32_t i = 0; i < samples->count; i++)
        values[i] = ms[i] > 0.0 ? pairs / (1e6 * ms[i]) : 0.0;
    struct kiln_bench_row row = {.x = (double)pull->count,
                                 .measure = "pairs",
                                 .technique =
                                     kiln_arena_text(pull->run->bench->arena, name, strlen(name)),
                                 .spread = kiln_spread_of(values, samples->count)};
    if (!row.technique)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for measurements");
    if (way != reference)
        row.faster = kiln_spread_of_ratios(pull->samples[reference].ms[KILN_PASS_simulate], ms,
                                           samples->count);
    return kiln_bench_add_row(pull->run->bench, &row, error);
}

static bool add_rows(const struct pull *pull, struct kiln_error *error)
{
    for (size_t way = 0; way < WAYS; way++) {
        const char *problem = is_splat(way) ? pull->problems[way - KILN_SIMD_COUNT] : NULL;
        char name[32];
        way_name(way, name);
        if (pull->samples[way].count > 0 && !add_row(pull, way, name, error))
            return false;
        if (problem &&
            !kiln_bench_add_note(pull->run->bench, error, "Not measured: %u bodies, %s: %s.",
                                 pull->count, name, problem))
            return false;
    }
    return true;
}

static bool run_pairs(const struct kiln_bench_run *run, uint32_t count, struct kiln_error *error)
{
    struct pull pull = {.run = run, .count = count};
    kiln_bench_say(run, "pairs of %u bodies", count);
    const bool ok = set_up(&pull, error) && take_turns(&pull, error) && add_rows(&pull, error);
    for (int i = 0; i < SPLATS; i++)
        kiln_force_splat_destroy(&pull.splats[i]);
    free(pull.samples);
    free(pull.accelerations);
    free(pull.sources);
    kiln_threads_destroy(&pull.threads);
    return ok;
}

/* ---- Frames ---------------------------------------------------------------------------------- */

static bool run_frames(const struct kiln_bench_run *run, uint32_t bodies, struct kiln_error *error)
{
    static const struct kiln_lane lane = {.name = "auto", .techniques = ""};
    struct kiln_settings settings = {.count = 0};
    char text[64];
    snprintf(text, sizeof text, "systems.stars.emit.bursts={0 s: %u}", bodies);
    kiln_set(run, &settings, text);
    kiln_set_picture(run, &settings, 1280, 720);
    const struct kiln_comparison comparison = {.scene = SCENE,
                                               .settings = &settings,
                                               .lanes = &lane,
                                               .lane_count = 1,
                                               .measures = KILN_MEASURE_WHOLE,
                                               .x = bodies,
                                               .rates = true};
    kiln_bench_say(run, "frames of %u bodies", bodies);
    return kiln_compare_lanes(run, &comparison, error);
}

static bool run_sizes(const struct kiln_bench_run *run, const struct kiln_bench_part *part,
                      bool (*run_size)(const struct kiln_bench_run *run, uint32_t bodies,
                                       struct kiln_error *error),
                      struct kiln_error *error)
{
    static const uint32_t sizes[] = {4096, 16384};
    const size_t count = run->params->quick ? 1 : sizeof sizes / sizeof *sizes;
    if (!kiln_bench_begin(run, part, error))
        return false;
    for (size_t i = 0; i < count; i++) {
        if (!run_size(run, sizes[i], error))
            return false;
    }
    return true;
}

bool kiln_suite_gravity(const struct kiln_bench_run *run, struct kiln_error *error)
{
    char narrowest[32];
    way_name(KILN_SIMD_NARROWEST, narrowest);
    const struct kiln_bench_part pairs = {
        .name = "gravity",
        .title =
            "Gravity of all pairs (Drone 2007, 7.4.3): thousands of millions of pairs a second",
        .sweep = "bodies",
        .unit = "G/s",
        .reference = kiln_arena_text(run->bench->arena, narrowest, strlen(narrowest)),
    };
    const struct kiln_bench_part frames = {
        .name = "gravity_frames",
        .title = "Frames at 1280x720 with a step each, of bodies that all attract each other",
        .sweep = "bodies",
        .unit = "fps",
    };
    return run_sizes(run, &pairs, run_pairs, error) &&
           kiln_bench_add_note(run->bench, error,
                               "Vectors of all widths give the same bits; splats (7.4.2) are added "
                               "up by the blending unit.") &&
           run_sizes(run, &frames, run_frames, error) && kiln_bench_drift(run, error);
}
