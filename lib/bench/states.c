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
#include "sim/step/simulate.h"

enum { STEPS = 62, MAX_TURNS = 5 }; /* after 60 steps the scene has all its particles */

/* A state of a given number of particles, and the measurements of it. */
struct keeping {
    const struct kiln_bench_run *run;
    double particles; /* the number that was asked for */
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_simulate *simulate;
    struct kiln_pool pool, other; /* `pool` is saved, and then loaded into `other` */
    struct kiln_state state;
    double save_ms[MAX_TURNS], load_ms[MAX_TURNS];
    uint32_t turns;
    double bytes; /* file size per living particle */
};

static void init_pool(const struct kiln_scene *scene, struct kiln_pool *pool)
{
    uint32_t capacities[KILN_MAX_SYSTEMS];
    for (uint32_t i = 0; i < scene->system_count; i++)
        capacities[i] = scene->systems[i].capacity;
    kiln_pool_init(pool, NULL, capacities, scene->system_count);
}

static bool fill(struct keeping *k, struct kiln_error *error)
{
    struct kiln_settings settings = {.count = 0};
    kiln_set_number(k->run, &settings, "systems.smoke.emit.rate", k->particles / 2);
    kiln_set_number(k->run, &settings, "systems.fire.emit.rate", k->particles / 2);
    kiln_set(k->run, &settings, "output.frames=3");
    k->scene = kiln_bench_load_scene(k->run, "bench/cloud.yaml", &settings, error);
    k->threads = kiln_threads_create(k->run->params->threads);
    if (!k->scene)
        return false;
    if (!k->threads)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for measurements");
    k->simulate = kiln_simulate_create(NULL, k->scene, KILN_SIMULATE_CPU, k->threads, error);
    if (!k->simulate)
        return false;
    init_pool(k->scene, &k->pool);
    init_pool(k->scene, &k->other);
    for (uint32_t step = 1; step <= STEPS; step++) {
        const struct kiln_bench_params *params = k->run->params;
        if (params->stop && params->stop(params->user))
            return kiln_error_set(error, KILN_INTERRUPTED, "stopped");
        if (!kiln_simulate_step(k->simulate, &k->pool, step, error))
            return false;
    }
    k->state.pool = &k->pool;
    k->state.info.step = STEPS;
    snprintf(k->state.info.motion, sizeof k->state.info.motion, "%064d", 0);
    return kiln_simulate_hash(k->simulate, &k->pool, &k->state.info.hash, &k->state.info.alive,
                              error);
}

/* Loads a state as a job does: checks the file, reads it, and hashes what it read. */
static bool load(struct keeping *k, const char *path, struct kiln_error *error)
{
    struct kiln_state_info info;
    struct kiln_state taken = {.pool = &k->other};
    struct kiln_state_hash hash;
    uint64_t alive;
    return kiln_state_check(path, &info, error) &&
           kiln_state_read(&taken, path, k->threads, error) &&
           kiln_simulate_hash(k->simulate, &k->other, &hash, &alive, error);
}

static bool take_turns(struct keeping *k, const char *path, struct kiln_error *error)
{
    const uint32_t turns = k->run->bench->repetitions;
    while (k->turns < turns && k->turns < MAX_TURNS) {
        double start_s = kiln_clock_seconds();
        if (!kiln_state_write(&k->state, path, true, k->threads, error))
            return false;
        k->save_ms[k->turns] = 1e3 * (kiln_clock_seconds() - start_s);
        start_s = kiln_clock_seconds();
        if (!load(k, path, error))
            return false;
        k->load_ms[k->turns++] = 1e3 * (kiln_clock_seconds() - start_s);
    }
    struct stat status;
    if (stat(path, &status) == 0 && k->state.info.alive > 0)
        k->bytes = (double)status.st_size / (double)k->state.info.alive;
    return true;
}

static void finish(struct keeping *k)
{
    if (k->simulate) {
        kiln_pool_finish(&k->pool);
        kiln_pool_finish(&k->other);
    }
    kiln_simulate_destroy(&k->simulate);
    kiln_threads_destroy(&k->threads);
    kiln_scene_destroy(&k->scene);
}

static bool add(const struct keeping *k, const char *measure, const char *unit,
                const double *values, uint32_t count, struct kiln_error *error)
{
    const struct kiln_bench_row row = {.x = (double)k->state.info.alive,
                                       .measure = measure,
                                       .technique = unit,
                                       .spread = kiln_spread_of(values, count)};
    return kiln_bench_add_row(k->run->bench, &row, error);
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
        struct keeping keeping = {.run = run, .particles = sizes[i]};
        kiln_bench_say(run, "a state of %g particles", sizes[i]);
        ok = fill(&keeping, error) && take_turns(&keeping, path, error) &&
             add(&keeping, "save", "ms", keeping.save_ms, keeping.turns, error) &&
             add(&keeping, "load", "ms", keeping.load_ms, keeping.turns, error) &&
             add(&keeping, "size", "bytes a particle", &keeping.bytes, 1, error);
        finish(&keeping);
    }
    unlink(path);
    return ok;
}
