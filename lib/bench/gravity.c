/* Runs the suite `gravity` of `kiln bench`: gravity of particles that all attract each other (Drone
 * 2007, 7.4.3). The table in lib/bench/bench.c names kiln_suite_gravity, which is called once a
 * run.
 *
 * The suite has three parts. The first measures pairs of bodies a second, without a scene: the
 * host's loop (sim/crowd/gravity.h) at each width of vectors that the machine has, and the paper's
 * way, which splats forces into a texture (papers/force_splat.h) and needs GL. The second measures
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
#include "bench/papers/papers.h"
#include "shared/random.h"

static const char SCENE[] = "bench/stars.yaml";

/* ---- Pairs ----------------------------------------------------------------------------------- */

/* The ways in GL to compute gravity. */
static const struct kiln_gravity_row *const ROWS[] = {&kiln_gravity_splats_32_row,
                                                      &kiln_gravity_splats_16_row};

enum {
    ROW_COUNT = sizeof ROWS / sizeof *ROWS,
    /* The ways that are compared: the first KILN_SIMD_COUNT are the widths of vectors, numbered as
     * enum kiln_simd, and the rows follow. */
    VARIANTS = KILN_SIMD_COUNT + ROW_COUNT,
    TARGETS_AT_A_TIME = 4 * KILN_GRAVITY_BLOCK, /* bodies that a thread takes at a time */
};

/* Holds the bodies of one size, and the times that were measured with them. */
struct pair_bench {
    const struct kiln_bench_run *run;
    struct kiln_threads *threads;
    uint32_t count, capacity; /* bodies; the same rounded up to a multiple of KILN_GRAVITY_BLOCK */
    float4 *sources;
    float3 *accelerations;
    void *ways[ROW_COUNT];           /* what the rows created; NULL: not measured */
    const char *problems[ROW_COUNT]; /* why a row is not measured */
    struct kiln_samples *samples;    /* [VARIANTS] */
};

static bool is_in_gl(size_t variant)
{
    return variant >= KILN_SIMD_COUNT;
}

static void variant_name(size_t variant, char name[32])
{
    if (is_in_gl(variant))
        snprintf(name, 32, "%s", ROWS[variant - KILN_SIMD_COUNT]->name);
    else
        snprintf(name, 32, "cpu, %s", kiln_simd_name((enum kiln_simd)variant));
}

static bool set_up(struct pair_bench *pair_bench, struct kiln_error *error)
{
    struct kiln_device *device = kiln_device_gl(pair_bench->run->device);
    pair_bench->threads = kiln_threads_create(pair_bench->run->params->threads);
    pair_bench->capacity =
        (pair_bench->count + KILN_GRAVITY_BLOCK - 1) / KILN_GRAVITY_BLOCK * KILN_GRAVITY_BLOCK;
    pair_bench->sources = calloc(pair_bench->capacity, sizeof *pair_bench->sources);
    pair_bench->accelerations = calloc(pair_bench->capacity, sizeof *pair_bench->accelerations);
    pair_bench->samples = calloc(VARIANTS, sizeof *pair_bench->samples);
    if (!pair_bench->threads || !pair_bench->sources || !pair_bench->accelerations ||
        !pair_bench->samples)
        return kiln_error_no_memory(error, "measurements");
    for (uint32_t i = 0; i < pair_bench->count; i++) {
        const float3 at = random_in_ball(random_stream(1, i), 0, false);
        pair_bench->sources[i] = FLOAT4(at.x, at.y, at.z, 1e-3f);
    }
    for (int i = 0; i < ROW_COUNT; i++) {
        if (!device)
            pair_bench->problems[i] = "there is no OpenGL";
        else if (device->info.software && pair_bench->count > ROWS[i]->most_in_software)
            pair_bench->problems[i] = "the measurement takes seconds on a software device";
        else if (!(pair_bench->ways[i] = ROWS[i]->create(device, pair_bench->count, error)))
            return false;
    }
    return true;
}

static bool run_variant(struct pair_bench *pair_bench, size_t variant, double *ms,
                        struct kiln_error *error)
{
    const float softening_square = 1e-4f;
    if (is_in_gl(variant))
        return ROWS[variant - KILN_SIMD_COUNT]->run(pair_bench->ways[variant - KILN_SIMD_COUNT],
                                                    pair_bench->sources, pair_bench->count,
                                                    softening_square, ms, error);
    struct kiln_gravity gravity = {.sources = pair_bench->sources,
                                   .count = pair_bench->count,
                                   .places = pair_bench->sources,
                                   .softening_square = softening_square,
                                   .accelerations = pair_bench->accelerations};
    const struct kiln_gravity_loops *loops =
        KILN_SIMD_PICK(kiln_gravity_loops, (enum kiln_simd)variant);
    const double before_s = kiln_clock_seconds();
    kiln_threads_for(pair_bench->threads, pair_bench->count, TARGETS_AT_A_TIME, loops->pull,
                     &gravity);
    *ms = 1e3 * (kiln_clock_seconds() - before_s);
    return true;
}

static bool can_run(const struct pair_bench *pair_bench, size_t variant)
{
    return is_in_gl(variant) ? pair_bench->ways[variant - KILN_SIMD_COUNT] != NULL
                             : kiln_simd_has((enum kiln_simd)variant);
}

/* Runs all ways by turns, so that a change of the machine's speed affects them alike. The first
 * turn only warms up. */
static bool take_turns(struct pair_bench *pair_bench, struct kiln_error *error)
{
    const struct kiln_bench_params *params = pair_bench->run->params;
    double spent_ms = 0.0;
    for (uint32_t turn = 0; turn <= pair_bench->run->bench->repetitions; turn++) {
        if (turn > KILN_BENCH_MIN_REPETITIONS && spent_ms > 1e3 * params->seconds)
            return true;
        for (size_t variant = 0; variant < VARIANTS; variant++) {
            struct kiln_samples *samples = &pair_bench->samples[variant];
            double ms = 0.0;
            if (!can_run(pair_bench, variant))
                continue;
            if (params->stop && params->stop(params->user))
                return kiln_error_set(error, KILN_INTERRUPTED, "stopped");
            if (!run_variant(pair_bench, variant, &ms, error))
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
static bool add_row(const struct pair_bench *pair_bench, size_t variant, const char *name,
                    struct kiln_error *error)
{
    const double pairs = (double)pair_bench->count * (double)pair_bench->count;
    const size_t reference = kiln_simd_narrowest();
    const struct kiln_samples *samples = &pair_bench->samples[variant];
    const double *ms = samples->ms[KILN_PASS_simulate];
    double values[KILN_BENCH_MAX_REPETITIONS];
    for (uint32_t i = 0; i < samples->count; i++)
        values[i] = ms[i] > 0.0 ? pairs / (1e6 * ms[i]) : 0.0;
    struct kiln_bench_row row = {
        .x = (double)pair_bench->count,
        .measure = "pairs",
        .technique = kiln_arena_text(pair_bench->run->bench->arena, name, strlen(name)),
        .spread = kiln_spread_of(values, samples->count)};
    if (!row.technique)
        return kiln_error_no_memory(error, "measurements");
    if (variant != reference)
        row.faster = kiln_spread_of_ratios(pair_bench->samples[reference].ms[KILN_PASS_simulate],
                                           ms, samples->count);
    return kiln_bench_add_row(pair_bench->run->bench, &row, error);
}

static bool add_rows(const struct pair_bench *pair_bench, struct kiln_error *error)
{
    for (size_t variant = 0; variant < VARIANTS; variant++) {
        const char *problem =
            is_in_gl(variant) ? pair_bench->problems[variant - KILN_SIMD_COUNT] : NULL;
        char name[32];
        variant_name(variant, name);
        if (pair_bench->samples[variant].count > 0 && !add_row(pair_bench, variant, name, error))
            return false;
        if (problem &&
            !kiln_bench_add_note(pair_bench->run->bench, error, "Not measured: %u bodies, %s: %s.",
                                 pair_bench->count, name, problem))
            return false;
    }
    return true;
}

static bool run_pairs(const struct kiln_bench_run *run, uint32_t count, struct kiln_error *error)
{
    struct pair_bench pair_bench = {.run = run, .count = count};
    kiln_bench_say(run, "pairs of %u bodies", count);
    const bool ok = set_up(&pair_bench, error) && take_turns(&pair_bench, error) &&
                    add_rows(&pair_bench, error);
    for (int i = 0; i < ROW_COUNT; i++) {
        if (pair_bench.ways[i])
            ROWS[i]->destroy(pair_bench.ways[i]);
    }
    free(pair_bench.samples);
    free(pair_bench.accelerations);
    free(pair_bench.sources);
    kiln_threads_destroy(&pair_bench.threads);
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
    variant_name(kiln_simd_narrowest(), narrowest);
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
