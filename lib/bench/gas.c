/* Runs the suite `gas` of `kiln bench`: steps of boxes of gas (gas_box.c), and a fire of the
 * library that is stepped, drawn (gas_drawn.c), saved and exported. */
#include "bench/gas.h"

#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/temporary.h"
#include "frame/technique.h"
#include "job/state.h"
#include "output/gas_vdb.h"
#include "scene/instant.h"
#include "scene/pool_layout.h"
#include "sim/gas/solver.h"
#include "sim/step/simulate.h"

#define FIRE "bench/gas.yaml"

enum { MAX_TURNS = KILN_GAS_TURNS };

bool kiln_bench_add_gas(const struct kiln_gas_sizes *sizes, uint32_t size, const char *measure,
                        const char *technique, const double *values, size_t count,
                        struct kiln_error *error)
{
    const struct kiln_bench_row row = {.x = sizes->edges[size],
                                       .measure = measure,
                                       .technique = technique,
                                       .spread = kiln_spread_of(values, count)};
    return kiln_bench_add_row(sizes->run->bench, &row, error);
}

static void set_scene(const struct kiln_gas_sizes *sizes, uint32_t size,
                      struct kiln_settings *settings)
{
    kiln_set_number(sizes->run, settings, "gas.fire.cells", sizes->edges[size]);
    if (sizes->run->params->quick)
        kiln_set(sizes->run, settings, "simulation.warmup=0.2");
}

/* ---- drawing --------------------------------------------------------------------------------- */

static bool measure_drawing(const struct kiln_gas_sizes *sizes, struct kiln_error *error)
{
    static const struct kiln_lane automatic = {.name = "auto", .techniques = ""};
    const struct kiln_bench_part part = {
        .name = "gas_drawn",
        .title = "A fire drawn at 1280x720: its light and the march of rays; the whole frame",
        .sweep = "cells along an edge",
        .unit = "ms",
    };
    if (!kiln_bench_begin(sizes->run, &part, error))
        return false;
    for (uint32_t i = 0; i < sizes->count; i++) {
        struct kiln_settings settings = {.count = 0};
        set_scene(sizes, i, &settings);
        kiln_set_picture(sizes->run, &settings, 1280, 720);
        kiln_bench_say(sizes->run, "a fire of %d cells, drawn", sizes->edges[i]);
        const struct kiln_comparison comparison = {
            .scene = FIRE,
            .settings = &settings,
            .lanes = &automatic,
            .lane_count = 1,
            .measures = KILN_MEASURE(gas) | KILN_MEASURE(simulate) | KILN_MEASURE_WHOLE,
            .x = sizes->edges[i]};
        if (!kiln_compare_lanes(sizes->run, &comparison, error))
            return false;
    }
    return true;
}

/* ---- files ----------------------------------------------------------------------------------- */

/* The fire after its warm-up, and what its files take. */
struct fire {
    const struct kiln_gas_sizes *sizes;
    uint32_t size;
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_simulate *simulate;
    struct kiln_pool pool, target; /* `pool` is saved, and then loaded into `target` */
    struct kiln_state state;
    double pass_s[GAS_TIMERS][MAX_TURNS], step_s[MAX_TURNS]; /* of all threads, of a step */
    uint32_t steps;
    double save_ms[MAX_TURNS], load_ms[MAX_TURNS], export_ms[MAX_TURNS];
    uint32_t turns;
    double state_bytes, export_bytes; /* of an active cell */
    double active;                    /* cells */
};

/* Runs a step, unless the caller wants no more. */
static bool run_step(struct fire *f, uint32_t step, struct kiln_error *error)
{
    const struct kiln_bench_params *params = f->sizes->run->params;
    if (params->stop && params->stop(params->user))
        return kiln_error_set(error, KILN_INTERRUPTED, "stopped");
    return kiln_simulate_step(f->simulate, &f->pool, step, error);
}

/* Runs steps after the warm-up, and measures them. */
static bool measure_steps(struct fire *f, uint32_t *step, struct kiln_error *error)
{
    const uint32_t turns = f->sizes->run->bench->repetitions;
    double before[GAS_TIMERS], after[GAS_TIMERS];
    kiln_simulate_gas_seconds(f->simulate, before);
    for (; f->steps < turns && f->steps < MAX_TURNS; f->steps++) {
        const double start_s = kiln_clock_cpu_seconds();
        if (!run_step(f, ++*step, error))
            return false;
        f->step_s[f->steps] = kiln_clock_cpu_seconds() - start_s;
        kiln_simulate_gas_seconds(f->simulate, after);
        for (int k = 0; k < GAS_TIMERS; k++) {
            f->pass_s[k][f->steps] = after[k] - before[k];
            before[k] = after[k];
        }
    }
    return true;
}

static bool make_fire(struct fire *f, struct kiln_error *error)
{
    const struct kiln_bench_run *run = f->sizes->run;
    struct kiln_settings settings = {.count = 0};
    set_scene(f->sizes, f->size, &settings);
    kiln_set_picture(f->sizes->run, &settings, 1280, 720);
    f->scene = kiln_bench_load_scene(run, FIRE, &settings, error);
    f->threads = kiln_threads_create(run->params->threads);
    if (!f->scene)
        return false;
    if (!f->threads)
        return kiln_error_no_memory(error, "measurements");
    const struct gas_kernels *kernels = f->sizes->kernels;
    f->simulate =
        kiln_simulate_create(kernels ? kernels->device : NULL, f->scene, KILN_SIMULATE_CPU,
                             kernels ? KILN_GAS_GL : KILN_GAS_CPU, f->threads, error);
    if (!f->simulate)
        return false;
    const struct kiln_pool_layout layout = kiln_scene_pool_layout(f->scene);
    if (!kiln_pool_init(&f->pool, NULL, &layout, error) ||
        !kiln_pool_init(&f->target, NULL, &layout, error))
        return false;
    uint32_t step = 0;
    while (step < f->scene->warmup_steps)
        if (!run_step(f, ++step, error))
            return false;
    if (!measure_steps(f, &step, error))
        return false;
    f->state.pool = &f->pool;
    f->state.info.step = step;
    snprintf(f->state.info.motion, sizeof f->state.info.motion, "%064d", 0);
    const struct kiln_gas *gas = &f->pool.gas[0];
    for (size_t i = 0; i < (size_t)gas->bricks.x * (size_t)gas->bricks.y * (size_t)gas->bricks.z;
         i++)
        f->active += gas->brick[i].now ? GAS_BRICK_CELLS : 0;
    return kiln_simulate_hash(f->simulate, &f->pool, &f->state.info.hash, &f->state.info.alive,
                              error);
}

static void finish_fire(struct fire *f)
{
    if (f->simulate) {
        kiln_pool_finish(&f->pool);
        kiln_pool_finish(&f->target);
    }
    kiln_simulate_destroy(&f->simulate);
    kiln_threads_destroy(&f->threads);
    kiln_scene_destroy(&f->scene);
}

/* Loads a state as a job does: checks the file, reads it, and hashes what it read. */
static bool load(struct fire *f, const char *path, struct kiln_error *error)
{
    struct kiln_state_info info;
    struct kiln_state loaded = {.pool = &f->target};
    struct kiln_state_hash hash;
    uint64_t alive;
    return kiln_state_check(path, &info, error) &&
           kiln_state_read(&loaded, path, f->threads, error) &&
           kiln_simulate_hash(f->simulate, &f->target, &hash, &alive, error);
}

static bool export(struct fire *f, const char *path, struct kiln_error *error)
{
    struct kiln_temporary file = {.target = NULL};
    const struct kiln_gas_vdb vdb = {
        .gas = &f->pool.gas[0],
        .shape = &f->scene->gas[0].shape,
        .half = true,
        .cutoff = 1e-3f,
        .uuid = "00000000-0000-8000-8000-000000000000",
    };
    const struct kiln_caller nobody = {.may_go_on = NULL};
    uint64_t voxels;
    if (!kiln_temporary_open(&file, path, error))
        return false;
    if (!kiln_gas_vdb_write(&vdb, &file, f->threads, &nobody, &voxels, error)) {
        kiln_temporary_discard(&file);
        return false;
    }
    return kiln_temporary_commit(&file, true, error);
}

static double bytes_of(const char *path, double cells)
{
    struct stat status;
    return stat(path, &status) == 0 && cells > 0.0 ? (double)status.st_size / cells : 0.0;
}

static bool take_turns(struct fire *f, const char *state, const char *vdb, struct kiln_error *error)
{
    const uint32_t turns = f->sizes->run->bench->repetitions;
    for (; f->turns < turns && f->turns < MAX_TURNS; f->turns++) {
        double start_s = kiln_clock_seconds();
        if (!kiln_state_write(&f->state, state, true, f->threads, error))
            return false;
        f->save_ms[f->turns] = 1e3 * (kiln_clock_seconds() - start_s);
        start_s = kiln_clock_seconds();
        if (!load(f, state, error))
            return false;
        f->load_ms[f->turns] = 1e3 * (kiln_clock_seconds() - start_s);
        start_s = kiln_clock_seconds();
        if (!export(f, vdb, error))
            return false;
        f->export_ms[f->turns] = 1e3 * (kiln_clock_seconds() - start_s);
    }
    f->state_bytes = bytes_of(state, f->active);
    f->export_bytes = bytes_of(vdb, f->active);
    return true;
}

/* ---- rows of fires --------------------------------------------------------------------------- */

static bool add_seconds(const struct fire *f, const char *measure, const double *seconds,
                        struct kiln_error *error)
{
    double values[MAX_TURNS];
    for (uint32_t i = 0; i < f->steps; i++)
        values[i] = 1e9 * seconds[i] / f->active;
    return kiln_bench_add_gas(f->sizes, f->size, measure, f->sizes->kernels ? "gas=gl" : "gas=cpu",
                              values, f->steps, error);
}

static bool add_steps(const struct kiln_gas_sizes *sizes, const struct fire *fires,
                      struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = "gas_fire",
        .title = "Steps of a fire that sources feed: all threads",
        .sweep = "cells along an edge",
        .unit = "ns an active cell",
    };
    if (!kiln_bench_begin(sizes->run, &part, error))
        return false;
    for (const struct fire *f = fires; f < fires + sizes->count; f++) {
        const double cells = pow(sizes->edges[f->size], 3);
        for (int k = 0; k < GAS_TIMERS; k++)
            if (k != GAS_TIMER_WALLS && /* there are none */
                !add_seconds(f, kiln_gas_pass_names[k], f->pass_s[k], error))
                return false;
        if (!add_seconds(f, "step", f->step_s, error) ||
            !kiln_bench_add_note(sizes->run->bench, error,
                                 "%d cells: %.0f %% of the cells were active.",
                                 sizes->edges[f->size], 100.0 * f->active / cells))
            return false;
    }
    return true;
}

static bool add_files(const struct kiln_gas_sizes *sizes, const struct fire *fires,
                      struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = "gas_files",
        .title = "The fire saved as a state, checked and loaded, and exported as halves; sizes",
        .sweep = "cells along an edge",
        .unit = "ms; bytes an active cell",
    };
    bool ok = kiln_bench_begin(sizes->run, &part, error);
    for (uint32_t i = 0; ok && i < sizes->count; i++) {
        const struct fire *f = &fires[i];
        ok = kiln_bench_add_gas(sizes, i, "save", "ms", f->save_ms, f->turns, error) &&
             kiln_bench_add_gas(sizes, i, "load", "ms", f->load_ms, f->turns, error) &&
             kiln_bench_add_gas(sizes, i, "state", "bytes", &f->state_bytes, 1, error) &&
             kiln_bench_add_gas(sizes, i, "export", "ms", f->export_ms, f->turns, error) &&
             kiln_bench_add_gas(sizes, i, "export", "bytes", &f->export_bytes, 1, error);
    }
    return ok;
}

/* Steps a fire of each size, and writes its files to the paths. */
static bool measure_fires(const struct kiln_gas_sizes *sizes, const char *state, const char *vdb,
                          struct kiln_error *error)
{
    struct fire fires[KILN_GAS_SIZES];
    struct kiln_gas_drawing drawings[KILN_GAS_SIZES] = {{.turns = 0}};
    for (uint32_t i = 0; i < sizes->count; i++) {
        fires[i] = (struct fire){.sizes = sizes, .size = i};
        kiln_bench_say(sizes->run, "a fire of %d cells: steps and files", sizes->edges[i]);
        struct fire *f = &fires[i];
        drawings[i].march = sizes->march;
        const bool ok = make_fire(f, error) && take_turns(f, state, vdb, error) &&
                        kiln_bench_draw_gas(sizes->run, f->scene, &f->pool, f->state.info.step,
                                            f->threads, &drawings[i], error);
        finish_fire(f);
        if (!ok)
            return false;
    }
    return add_steps(sizes, fires, error) && add_files(sizes, fires, error) &&
           kiln_bench_add_drawings(sizes, drawings, error);
}

/* ---- the suite ------------------------------------------------------------------------------- */

static bool measure(const struct kiln_gas_sizes *sizes, struct kiln_error *error)
{
    const struct kiln_bench_params *params = sizes->run->params;
    char state[KILN_PATH_SIZE], vdb[KILN_PATH_SIZE];
    if (!kiln_path_join(state, params->scratch, "kiln-bench-gas.kilnstate", error) ||
        !kiln_path_join(vdb, params->scratch, "kiln-bench-gas.vdb", error))
        return false;
    const bool ok = kiln_bench_gas_boxes(sizes, error) && measure_fires(sizes, state, vdb, error) &&
                    measure_drawing(sizes, error);
    unlink(state);
    unlink(vdb);
    return ok;
}

bool kiln_suite_gas(const struct kiln_bench_run *run, struct kiln_error *error)
{
    struct kiln_gas_sizes sizes = {.run = run, .edges = {64, 128}, .count = KILN_GAS_SIZES};
    struct kiln_techniques techniques;
    if (run->params->quick)
        sizes.edges[0] = 32;
    if (run->params->cells > 0)
        sizes.edges[0] = (int32_t)run->params->cells;
    if (run->params->quick || run->params->cells > 0)
        sizes.count = 1;
    if (!kiln_techniques_choose(kiln_device_get_info(run->device), run->params->techniques,
                                run->params->technique_count, &techniques, error))
        return false;
    sizes.march = techniques.march;
    if (techniques.gas == KILN_GAS_CPU)
        return measure(&sizes, error);
    sizes.kernels = gas_kernels_create(run->device, error);
    const bool ok = sizes.kernels && measure(&sizes, error);
    gas_kernels_destroy(&sizes.kernels);
    return ok;
}
