/* Runs the suite `states` of `kiln bench`, which measures the size of saved states, and the times
 * to save and to load one. */
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "bench/suite.h"
#include "job/state.h"
#include "scene/pool_layout.h"
#include "sim/step/simulate.h"

enum { STEPS = 62, MAX_TURNS = 5 }; /* after 60 steps the scene has all its particles */

/* A state of a given number of particles, and the measurements of it. */
struct state_bench {
    const struct kiln_bench_run *run;
    double particles; /* the number that was asked for */
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_simulate *simulate;
    struct kiln_pool pool, target; /* `pool` is saved, and then loaded into `target` */
    struct kiln_state state;
    double save_ms[MAX_TURNS], load_ms[MAX_TURNS];
    uint32_t turns;
    double bytes; /* file size per living particle */
};

static bool fill(struct state_bench *b, struct kiln_error *error)
{
    struct kiln_settings settings = {.count = 0};
    kiln_set_number(b->run, &settings, "systems.smoke.emit.rate", b->particles / 2);
    kiln_set_number(b->run, &settings, "systems.fire.emit.rate", b->particles / 2);
    kiln_set(b->run, &settings, "output.frames=3");
    b->scene = kiln_bench_load_scene(b->run, "bench/cloud.yaml", &settings, error);
    b->threads = kiln_threads_create(b->run->params->threads);
    if (!b->scene)
        return false;
    if (!b->threads)
        return kiln_error_no_memory(error, "measurements");
    b->simulate =
        kiln_simulate_create(NULL, b->scene, KILN_SIMULATE_CPU, KILN_GAS_CPU, b->threads, error);
    if (!b->simulate)
        return false;
    const struct kiln_pool_layout layout = kiln_scene_pool_layout(b->scene);
    if (!kiln_pool_init(&b->pool, NULL, &layout, error) ||
        !kiln_pool_init(&b->target, NULL, &layout, error))
        return false;
    for (uint32_t step = 1; step <= STEPS; step++) {
        const struct kiln_bench_params *params = b->run->params;
        if (params->stop && params->stop(params->user))
            return kiln_error_set(error, KILN_INTERRUPTED, "stopped");
        if (!kiln_simulate_step(b->simulate, &b->pool, step, error))
            return false;
    }
    b->state.pool = &b->pool;
    b->state.info.step = STEPS;
    snprintf(b->state.info.motion, sizeof b->state.info.motion, "%064d", 0);
    return kiln_simulate_hash(b->simulate, &b->pool, &b->state.info.hash, &b->state.info.alive,
                              error);
}

/* Loads a state as a job does: checks the file, reads it, and hashes what it read. */
static bool load(struct state_bench *b, const char *path, struct kiln_error *error)
{
    struct kiln_state_info info;
    struct kiln_state loaded = {.pool = &b->target};
    struct kiln_state_hash hash;
    uint64_t alive;
    return kiln_state_check(path, &info, error) &&
           kiln_state_read(&loaded, path, b->threads, error) &&
           kiln_simulate_hash(b->simulate, &b->target, &hash, &alive, error);
}

static bool take_turns(struct state_bench *b, const char *path, struct kiln_error *error)
{
    const uint32_t turns = b->run->bench->repetitions;
    while (b->turns < turns && b->turns < MAX_TURNS) {
        double start_s = kiln_clock_seconds();
        if (!kiln_state_write(&b->state, path, true, b->threads, error))
            return false;
        b->save_ms[b->turns] = 1e3 * (kiln_clock_seconds() - start_s);
        start_s = kiln_clock_seconds();
        if (!load(b, path, error))
            return false;
        b->load_ms[b->turns++] = 1e3 * (kiln_clock_seconds() - start_s);
    }
    struct stat status;
    if (stat(path, &status) == 0 && b->state.info.alive > 0)
        b->bytes = (double)status.st_size / (double)b->state.info.alive;
    return true;
}

static void finish(struct state_bench *b)
{
    if (b->simulate) {
        kiln_pool_finish(&b->pool);
        kiln_pool_finish(&b->target);
    }
    kiln_simulate_destroy(&b->simulate);
    kiln_threads_destroy(&b->threads);
    kiln_scene_destroy(&b->scene);
}

static bool add(const struct state_bench *b, const char *measure, const char *unit,
                const double *values, uint32_t count, struct kiln_error *error)
{
    const struct kiln_bench_row row = {.x = (double)b->state.info.alive,
                                       .measure = measure,
                                       .technique = unit,
                                       .spread = kiln_spread_of(values, count)};
    return kiln_bench_add_row(b->run->bench, &row, error);
}

bool kiln_suite_states(const struct kiln_bench_run *run, struct kiln_error *error)
{
    static const double sizes[] = {1e3, 160e3, 1e6, 16e6};
    const struct kiln_bench_part part = {
        .name = "states",
        .title = "Saved states: time to save one, and time to check and load one; size",
        .sweep = "particles",
        .unit = "ms; bytes a particle",
    };
    char path[KILN_PATH_SIZE];
    if (!kiln_bench_begin(run, &part, error) ||
        !kiln_path_join(path, run->params->scratch, "kiln-bench.kilnstate", error))
        return false;
    bool ok = true;
    for (size_t i = 0; i < (run->params->quick ? 1 : sizeof sizes / sizeof *sizes) && ok; i++) {
        struct state_bench state_bench = {.run = run, .particles = sizes[i]};
        kiln_bench_say(run, "a state of %g particles", sizes[i]);
        ok = fill(&state_bench, error) && take_turns(&state_bench, path, error) &&
             add(&state_bench, "save", "ms", state_bench.save_ms, state_bench.turns, error) &&
             add(&state_bench, "load", "ms", state_bench.load_ms, state_bench.turns, error) &&
             add(&state_bench, "size", "bytes a particle", &state_bench.bytes, 1, error);
        finish(&state_bench);
    }
    unlink(path);
    return ok;
}
