/* Measures steps of boxes of gas for the suite `gas` of `kiln bench`. A fire burns in a box, of
 * which all bricks are active, or a quarter of them. Levels of vectors and numbers of threads are
 * lanes. All lanes step the same gas in turn, which they may do because all of them compute the
 * same bits. */
#include <malloc.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "bench/gas.h"
#include "shared/exact.h"
#include "shared/random.h"
#include "sim/gas/solver.h"

enum {
    MOST_THREADS = 2,
    LANES = KILN_SIMD_COUNT * MOST_THREADS,
    WARM_UP = 3,
    CYCLES = 2, /* of the multigrid, as scenes have by default */
};

const char *const kiln_gas_pass_names[GAS_TIMERS] = {
    [GAS_TIMER_TRACE] = "trace",       [GAS_TIMER_REACT] = "react",
    [GAS_TIMER_SOURCES] = "sources",   [GAS_TIMER_WALLS] = "walls",
    [GAS_TIMER_PUSH] = "push",         [GAS_TIMER_DIVERGE] = "diverge",
    [GAS_TIMER_PRESSURE] = "pressure", [GAS_TIMER_PROJECT] = "project",
};

/* A way to step the gas, and what its steps took: of all threads by pass and in all, and elapsed.
 */
struct lane {
    const char *name;
    enum kiln_simd simd;
    uint32_t threads;
    double pass_s[GAS_TIMERS][KILN_BENCH_MAX_REPETITIONS];
    double cpu_s[KILN_BENCH_MAX_REPETITIONS], elapsed_s[KILN_BENCH_MAX_REPETITIONS];
    uint32_t turns;
};

struct box {
    const struct kiln_bench_run *run;
    int32_t edge; /* cells */
    bool quarter; /* two bricks of eight are active, at opposite corners of the box */
    struct kiln_gas gas;
    struct gas_solver solver;
    struct kiln_threads *threads[MOST_THREADS];
    struct gas_kernels *kernels; /* NULL: the host steps the gas */
    struct lane *lanes;
    size_t lane_count;
    struct kiln_gas_step step;
    struct gas_stir stir;
    double active; /* part of the bricks that was active */
};

/* ---- the gas --------------------------------------------------------------------------------- */

/* Fills in a fire as the study of gas had: flames in a box 2.4 m high, cells of which move by about
 * half a cell in a step. */
static void set_constants(struct box *box)
{
    const float cell = 2.4f / (float)box->edge, dt = 1.6f / (float)box->edge;
    const float burnt = 1.0f - exact_exp(-2.4f * dt);
    box->step = (struct kiln_gas_step){
        .dt = dt,
        .cell = cell,
        .cells_a_velocity = dt / cell,
        .rise = FLOAT4(0.0f, 2.0f * dt, 0.0f, 0.0f),
        .slow = exact_exp(-0.05f * dt),
        .ignition = 0.25f,
        .burnt = burnt,
        .heat = 1.3f,
        .soot = 0.3f,
        .expand = 1.6f,
        .expansion = 1.6f / dt,
        .flame_fade = 2.0f * dt,
        .flame_gain = 0.15f / dt,
        .smoke_left = exact_exp(-0.2f * dt),
        .smoke_burnt = dt,
        .cool = 0.9f * dt,
        .cool_even = 0.25f * dt,
        .hottest = 1.2f,
        .confinement = 0.125f * dt,
        .smoothing = 0.01f,
        .keep_velocity = 1,
    };
    box->stir = (struct gas_stir){
        .strength = 2.0f * dt, .scale = cell / 0.22f, .octaves = 2, .seed = random_mix(7)};
}

/* Returns the regions that sources would wake. */
static uint32_t regions_of(const struct box *box, struct gas_region regions[2])
{
    const int32_t all = box->edge / GAS_BRICK, half = all / 2;
    if (!box->quarter) {
        regions[0] = (struct gas_region){{0, 0, 0}, {all, all, all}};
        return 1;
    }
    regions[0] = (struct gas_region){{0, 0, 0}, {half, half, half}};
    regions[1] = (struct gas_region){{half, half, half}, {all, all, all}};
    return 2;
}

/* Puts a column of burning gas into the middle of a region, between an eighth and a half of its
 * height, which moves upwards. */
static void light(struct kiln_gas *gas, const struct gas_region *region)
{
    const int32_t first[3] = {region->low.x * GAS_BRICK, region->low.y * GAS_BRICK,
                              region->low.z * GAS_BRICK};
    const int32_t cells = (region->high.x - region->low.x) * GAS_BRICK;
    const float middle = 0.5f * (float)cells, radius = 0.15f * (float)cells;
    for (int32_t z = 0; z < cells; z++)
        for (int32_t y = cells / 8; y < cells / 2; y++)
            for (int32_t x = 0; x < cells; x++) {
                const float a = (float)x + 0.5f - middle, b = (float)z + 0.5f - middle;
                const int32_t at[3] = {first[0] + x, first[1] + y, first[2] + z};
                const size_t brick = kiln_gas_brick_index(gas, at[0] / GAS_BRICK, at[1] / GAS_BRICK,
                                                          at[2] / GAS_BRICK);
                const int32_t place =
                    (at[2] % GAS_BRICK * GAS_BRICK + at[1] % GAS_BRICK) * GAS_BRICK +
                    at[0] % GAS_BRICK;
                float *cell = gas->brick[brick].now + (size_t)place * GAS_CARRIED;
                if (a * a + b * b > radius * radius)
                    continue;
                cell[GAS_SMOKE] = 0.3f;
                cell[GAS_TEMPERATURE] = 0.65f;
                cell[GAS_FUEL] = 0.5f;
                gas->has_gas[brick] = 1;
                gas->faces[1][at[2] * gas->plane + at[1] * gas->row + at[0]] = 0.8f;
            }
}

/* Returns the bytes of the process that are in memory, after those that it freed went back. */
static double resident_bytes(void)
{
    char text[64] = "";
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    FILE *file = fopen("/proc/self/statm", "re");
    const bool found = file && fgets(text, sizeof text, file);
    if (file)
        fclose(file);
    const char *second = found ? strchr(text, ' ') : NULL; /* its resident part, in pages */
    return second ? (double)strtoull(second, NULL, 10) * (double)sysconf(_SC_PAGESIZE) : 0.0;
}

static bool prepare(struct box *box, struct kiln_error *error)
{
    struct gas_region regions[2];
    const uint32_t count = regions_of(box, regions);
    const enum gas_failure failure =
        gas_solver_prepare(&box->solver, regions, count, false, false, error);
    return failure == GAS_STEPPED ||
           (failure == GAS_NO_MEMORY && kiln_error_no_memory(error, "gas"));
}

static bool make(struct box *box, struct kiln_error *error)
{
    const int32_t n = box->edge;
    enum kiln_simd simd;
    const struct kiln_gas_shape shape = {
        .cells = {n, n, n}, .cell = 2.4f / (float)n, .closed = {[2] = true}, /* the floor */
    };
    struct gas_region regions[2];
    const uint32_t count = regions_of(box, regions);
    kiln_gas_init(&box->gas, &shape);
    if (!kiln_simd_choose(&simd, error))
        return false;
    for (uint32_t i = 0; i < MOST_THREADS; i++) {
        box->threads[i] = kiln_threads_create(i + 1);
        if (!box->threads[i])
            return kiln_error_no_memory(error, "gas");
    }
    set_constants(box);
    if (!gas_solver_init(&box->solver, &box->gas, box->threads[MOST_THREADS - 1], simd,
                         box->kernels))
        return kiln_error_no_memory(error, "gas");
    if (!prepare(box, error))
        return false;
    box->solver.measures = true;
    for (uint32_t i = 0; i < count; i++)
        light(&box->gas, &regions[i]);
    return true;
}

static void finish(struct box *box)
{
    if (box->solver.gas)
        gas_solver_finish(&box->solver);
    kiln_gas_finish(&box->gas);
    for (uint32_t i = 0; i < MOST_THREADS; i++)
        kiln_threads_destroy(&box->threads[i]);
    free(box->lanes);
}

/* ---- steps ----------------------------------------------------------------------------------- */

static bool list_lanes(struct box *box, struct kiln_error *error)
{
    box->lanes = calloc(LANES, sizeof *box->lanes);
    if (!box->lanes)
        return kiln_error_no_memory(error, "measurements");
    if (box->kernels) {
        struct lane *lane = &box->lanes[box->lane_count++];
        lane->name = "gl";
        lane->threads = MOST_THREADS;
        return kiln_simd_choose(&lane->simd, error);
    }
    for (uint32_t k = 0; k < KILN_SIMD_COUNT; k++)
        for (uint32_t threads = 1; threads <= MOST_THREADS && kiln_simd_has(k); threads++) {
            struct lane *lane = &box->lanes[box->lane_count++];
            lane->simd = (enum kiln_simd)k;
            lane->threads = threads;
            lane->name =
                kiln_arena_format(box->run->bench->arena, "%s, %u thread%s",
                                  kiln_simd_name(lane->simd), threads, threads == 1 ? "" : "s");
            if (!lane->name)
                return kiln_error_no_memory(error, "measurements");
        }
    return true;
}

/* Runs a step in the way of a lane, and takes note of its times if it counts. */
static bool run_step(struct box *box, struct lane *lane, bool counts, struct kiln_error *error)
{
    static const struct gas_hooks hooks = {.context = NULL};
    struct gas_solver *solver = &box->solver;
    const struct kiln_bench_params *params = box->run->params;
    struct gas_pass pass = {.gas = &box->gas, .step = &box->step, .stir = box->stir};
    if (params->stop && params->stop(params->user))
        return kiln_error_set(error, KILN_INTERRUPTED, "stopped");
    solver->threads = box->threads[lane->threads - 1];
    solver->advect = KILN_SIMD_PICK(kiln_gas_advect, lane->simd);
    solver->faces = KILN_SIMD_PICK(kiln_gas_faces, lane->simd);
    solver->multigrid = KILN_SIMD_PICK(kiln_gas_multigrid, lane->simd);
    memset(solver->seconds, 0, sizeof solver->seconds);
    const double start_s = kiln_clock_seconds(), start_cpu_s = kiln_clock_cpu_seconds();
    if (!prepare(box, error))
        return false;
    const enum gas_failure failure = gas_solver_step(solver, &pass, &hooks, CYCLES, 0.0, error);
    if (failure != GAS_STEPPED)
        return failure == GAS_STOPPED ||
               kiln_error_set(error, KILN_DEVICE_FAILED, "gas: the box cannot be stepped");
    const uint32_t turn = lane->turns;
    if (!counts)
        return true;
    lane->cpu_s[turn] = kiln_clock_cpu_seconds() - start_cpu_s;
    lane->elapsed_s[turn] = kiln_clock_seconds() - start_s;
    for (int k = 0; k < GAS_TIMERS; k++)
        lane->pass_s[k][turn] = solver->seconds[k];
    lane->turns++;
    box->active += solver->active.count;
    return true;
}

static bool take_turns(struct box *box, struct kiln_error *error)
{
    const uint32_t turns = box->run->bench->repetitions;
    double start_s = 0.0;
    for (uint32_t i = 0; i < WARM_UP + turns; i++) {
        if (i == WARM_UP)
            start_s = kiln_clock_seconds();
        if (i >= WARM_UP + KILN_BENCH_MIN_REPETITIONS &&
            kiln_clock_seconds() - start_s > box->run->params->seconds)
            break;
        for (size_t k = 0; k < box->lane_count; k++)
            if (!run_step(box, &box->lanes[k], i >= WARM_UP, error))
                return false;
    }
    const double bricks = pow(box->edge / GAS_BRICK, 3);
    box->active /= bricks * (double)box->lane_count * box->lanes[0].turns;
    return true;
}

/* ---- rows ------------------------------------------------------------------------------------ */

static bool add_row(const struct box *box, const char *measure, const struct lane *lane,
                    const double *seconds, double factor, struct kiln_error *error)
{
    double values[KILN_BENCH_MAX_REPETITIONS];
    for (uint32_t i = 0; i < lane->turns; i++)
        values[i] = factor * seconds[i];
    const struct kiln_bench_row row = {.x = box->edge,
                                       .measure = measure,
                                       .technique = lane->name,
                                       .spread = kiln_spread_of(values, lane->turns)};
    return kiln_bench_add_row(box->run->bench, &row, error);
}

/* Adds the processor time of a cell of the box, by pass. */
static bool add_passes(const struct box *box, struct kiln_error *error)
{
    const double a_cell = 1e9 / pow(box->edge, 3);
    const struct lane *end = box->lanes + box->lane_count;
    for (int k = 0; k < GAS_TIMERS; k++)
        for (const struct lane *lane = box->lanes; lane < end; lane++)
            if (k != GAS_TIMER_SOURCES && k != GAS_TIMER_WALLS && /* the box has neither */
                !add_row(box, kiln_gas_pass_names[k], lane, lane->pass_s[k], a_cell, error))
                return false;
    for (const struct lane *lane = box->lanes; lane < end; lane++)
        if (!add_row(box, "step", lane, lane->cpu_s, a_cell, error) ||
            !add_row(box, "elapsed, ms", lane, lane->elapsed_s, 1e3, error))
            return false;
    return true;
}

/* What a box took. */
struct found {
    double bytes, active; /* as in struct box */
};

static bool measure_box(const struct kiln_gas_sizes *sizes, int32_t edge, bool quarter,
                        struct found *found, struct kiln_error *error)
{
    const struct kiln_bench_run *run = sizes->run;
    struct box box = {.run = run, .edge = edge, .quarter = quarter, .kernels = sizes->kernels};
    kiln_bench_say(run, "a box of %d cells along an edge%s", edge,
                   quarter ? ", of which a quarter is active" : "");
    const double before = resident_bytes();
    bool ok = list_lanes(&box, error) && make(&box, error) && take_turns(&box, error);
    *found = (struct found){resident_bytes() - before, box.active};
    ok = ok && add_passes(&box, error) &&
         kiln_bench_add_note(run->bench, error, "%d cells: %.0f %% of the bricks were active.",
                             edge, 100.0 * box.active);
    finish(&box);
    return ok;
}

static bool measure_boxes(const struct kiln_gas_sizes *sizes, bool quarter, struct found *found,
                          struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = quarter ? "gas_quarter" : "gas",
        .title = quarter ? "Steps of boxes of gas, of which a quarter is active: all threads"
                         : "Steps of boxes of gas, all of which are active: all threads",
        .sweep = "cells along an edge",
        .unit = "ns a cell of the box; ms",
    };
    if (!kiln_bench_begin(sizes->run, &part, error))
        return false;
    for (uint32_t i = 0; i < sizes->count; i++)
        if (!measure_box(sizes, sizes->edges[i], quarter, &found[i], error))
            return false;
    return true;
}

/* Adds the bytes of an active cell, by the full box, and those of an idle one, by the other box. */
static bool add_memory(const struct kiln_gas_sizes *sizes, const struct found *full,
                       const struct found *quarter, struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = "gas_memory",
        .title = "Memory of gas and its solver, by what the process grows",
        .sweep = "cells along an edge",
        .unit = "bytes a cell",
    };
    if (!kiln_bench_begin(sizes->run, &part, error))
        return false;
    for (uint32_t i = 0; i < sizes->count; i++) {
        const double cells = pow(sizes->edges[i], 3), part_active = quarter[i].active;
        const double active = full[i].bytes / (cells * full[i].active);
        const double idle = part_active < 1.0 ? (quarter[i].bytes / cells - part_active * active) /
                                                    (1.0 - part_active)
                                              : 0.0;
        if (!kiln_bench_add_gas(sizes, i, "active", "bytes", &active, 1, error) ||
            !kiln_bench_add_gas(sizes, i, "idle", "bytes", &idle, 1, error))
            return false;
    }
    return true;
}

bool kiln_bench_gas_boxes(const struct kiln_gas_sizes *sizes, struct kiln_error *error)
{
    struct found full[KILN_GAS_SIZES], quarter[KILN_GAS_SIZES];
    return measure_boxes(sizes, false, full, error) && measure_boxes(sizes, true, quarter, error) &&
           add_memory(sizes, full, quarter, error);
}
