/* Holds the table of the suites of `kiln bench`, and runs them. cmd/bench.c calls kiln_bench_run
 * once. That function runs the suites that are asked for and then measures the caller's scenes; if
 * neither is asked for, it runs every suite. With another program, it compares both on the scenes.
 * The suites `jobs` and `threads` take the caller's scenes as their input, so these are not
 * measured by themselves then.
 *
 * Parameters are checked before a device is opened, since a run takes minutes and a misspelt name
 * should not cost them. A new suite needs a row here and a function in bench/suite.h. Names are
 * words of the command line and of results, so a new name makes older results hard to compare. */
#include <string.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/simd.h"
#include "base/thread.h"
#include "bench/papers/papers.h"

#define JOBS    "jobs"
#define THREADS "threads"

/* A row has a suite's name, its help, about how many minutes it takes on two cores without a GPU,
 * and its function. Suites run in this order if all of them run. */
static const struct kiln_suite_row SUITES[] = {
    {{"seed", "the first techniques and auto compared: whole frames with PNG, and stages", 2},
     kiln_suite_seed},
    {{"sizes", "frames of the four sizes of Heinz 2019, table 4.1, pass by pass", 0.5},
     kiln_suite_sizes},
    {{"figure4.4", "Heinz 2019, figure 4.4: techniques of simulation by particles", 1},
     kiln_suite_figure_4_4},
    {{"figure4.5", "Heinz 2019, figure 4.5: rendering fire and smoke, and the whole frame", 1.5},
     kiln_suite_figure_4_5},
    {{"figure4.6", "Heinz 2019, figure 4.6: techniques of sorting by particles", 1},
     kiln_suite_figure_4_6},
    {{"table1", "UberFlow, table 1: sorting 128^2 to 1024^2 particles", 1}, kiln_suite_table_1},
    {{"table2", "UberFlow, table 2: experiments E1 to E5", 1.5}, kiln_suite_table_2},
    {{"curves", "cost over 1,000 to 4,000,000 particles and 4 to 256 pixels", 1},
     kiln_suite_curves},
    {{"groups", "kernels by the size of their work groups (Heinz 2019, 2.2.5)", 1.5},
     kiln_suite_groups},
    {{"forces", "simulation by its force and integrator; baked winds", 0.7}, kiln_suite_forces},
    {{"colliders",
      "simulation by the objects that particles bounce off, and the building of volumes", 0.5},
     kiln_suite_colliders},
    {{"balls", "simulation of 100,000 balls that collide, without and with spin", 0.2},
     kiln_suite_balls},
    {{"flock",
      "flocks of 4,096 and 16,384, by the particles that each looks at (Drone 2007, 7.4.4)", 0.3},
     kiln_suite_flock},
    {{"gravity",
      "gravity of all pairs, frames with it, and conservation of energy (Drone 2007, 7.4.3)", 0.5},
     kiln_suite_gravity},
    {{"paint", "painting with particles by its gather (Drone 2007, 7.6.1)", 0.4}, kiln_suite_paint},
    {{"bytes", "memory and communication of techniques (Heinz 2019, 4.2)", 0.2}, kiln_suite_bytes},
    {{"states", "size of saved states, and time to save and to load one", 1.5}, kiln_suite_states},
    {{"gas", "steps of gas by pass, level and threads; its memory, drawing, states and export", 2},
     kiln_suite_gas},
    {{JOBS, "64 parts of a clip with states compared with one run, and many workers", 5},
     kiln_suite_jobs},
    {{THREADS, "CPU time of a frame with 1, 2 and 8 threads, and how much of it is serial", 0.5},
     kiln_suite_threads},
    {{"output", "whole jobs to PNG, EXR and mp4, compared with the time of their stages", 1},
     kiln_suite_output},
};
enum { SUITE_COUNT = sizeof SUITES / sizeof *SUITES };

void kiln_visit_benches(void (*visit)(void *user, const struct kiln_bench_suite *suite), void *user)
{
    for (size_t i = 0; i < SUITE_COUNT; i++)
        visit(user, &SUITES[i].info);
}

bool kiln_bench_names(const struct kiln_bench_params *params, const char *suite)
{
    for (size_t i = 0; i < params->suite_count; i++) {
        if (strcmp(params->suites[i], suite) == 0)
            return true;
    }
    return false;
}

/* Returns whether a suite takes the scenes, which are then not measured by themselves. */
static bool are_for_suites(const struct kiln_bench_params *params)
{
    return kiln_bench_names(params, JOBS) || kiln_bench_names(params, THREADS);
}

static const struct kiln_suite_row *find_suite(const char *name, struct kiln_error *error)
{
    const char *names[SUITE_COUNT];
    for (size_t i = 0; i < SUITE_COUNT; i++) {
        names[i] = SUITES[i].info.name;
        if (strcmp(names[i], name) == 0)
            return &SUITES[i];
    }
    const char *nearest = kiln_text_nearest(name, names, SUITE_COUNT);
    kiln_error_set(error, KILN_USAGE, "'%s' is neither a scene file (*.yaml) nor a suite%s%s%s",
                   name, nearest ? " (did you mean '" : "", nearest ? nearest : "",
                   nearest ? "'?)" : "");
    return NULL;
}

static bool check_stage(const char *stage, struct kiln_error *error)
{
    const char *names[KILN_STAGE_COUNT];
    for (size_t i = 0; i < KILN_STAGE_COUNT; i++) {
        names[i] = kiln_stage_name(i);
        if (strcmp(names[i], stage) == 0)
            return true;
    }
    const char *nearest = kiln_text_nearest(stage, names, KILN_STAGE_COUNT);
    return kiln_error_set(error, KILN_USAGE, "there is no stage '%s'%s%s%s", stage,
                          nearest ? " (did you mean '" : "", nearest ? nearest : "",
                          nearest ? "'?)" : "");
}

/* Checks the parameters as far as that is possible without a device. Scenes are loaded for this
 * check, and loaded again when they are measured. */
static bool check(const struct kiln_bench_params *params, struct kiln_error *error)
{
    if (params->repetitions < KILN_BENCH_MIN_REPETITIONS ||
        params->repetitions > KILN_BENCH_MAX_REPETITIONS)
        return kiln_error_set(error, KILN_USAGE, "found %u repetitions; allowed are %d to %d",
                              params->repetitions, KILN_BENCH_MIN_REPETITIONS,
                              KILN_BENCH_MAX_REPETITIONS);
    for (size_t i = 0; i < params->suite_count; i++) {
        if (!find_suite(params->suites[i], error))
            return false;
    }
    if (params->scene_count > 1 && kiln_bench_names(params, JOBS))
        return kiln_error_set(error, KILN_USAGE, "the suite " JOBS " takes one scene; found %zu",
                              params->scene_count);
    for (size_t i = 0; i < params->stage_count; i++) {
        if (!check_stage(params->stages[i], error))
            return false;
    }
    for (size_t i = 0; i < params->scene_count; i++) {
        struct kiln_scene *scene = kiln_scene_load(params->scenes[i], &params->scene, error);
        if (!scene)
            return false;
        kiln_scene_destroy(&scene);
    }
    return true;
}

static bool run_all(struct kiln_bench_run *run, struct kiln_error *error)
{
    const struct kiln_bench_params *params = run->params;
    if (params->against)
        return kiln_bench_against(run, error);
    bool every = params->suite_count == 0 && params->scene_count == 0;
    for (size_t i = 0; i < (every ? SUITE_COUNT : params->suite_count); i++) {
        const struct kiln_suite_row *suite =
            every ? &SUITES[i] : find_suite(params->suites[i], error);
        if (!suite)
            return false;
        run->suite = suite->info.name;
        if (!suite->run(run, error))
            return false;
    }
    for (size_t i = 0; i < params->scene_count && !are_for_suites(params); i++) {
        run->suite = params->scenes[i];
        if (!kiln_bench_scene(run, params->scenes[i], error))
            return false;
    }
    return true;
}

/* Checks that the device allows the techniques that the caller asks for. Techniques that a suite
 * adds may turn out to be impossible, and are then not measured. */
static bool check_techniques(const struct kiln_bench_run *run, struct kiln_error *error)
{
    struct kiln_techniques unused;
    enum kiln_simd wanted;
    return kiln_simd_choose(&wanted, error) &&
           kiln_techniques_choose(kiln_device_get_info(run->device), run->params->techniques,
                                  run->params->technique_count, &unused, error);
}

static uint32_t count_cores(void)
{
    struct kiln_threads *threads = kiln_threads_create(0);
    uint32_t count = threads ? kiln_threads_count(threads) : 1;
    kiln_threads_destroy(&threads);
    return count;
}

struct kiln_bench *kiln_bench_run(const struct kiln_bench_params *params, struct kiln_error *error)
{
    if (!check(params, error))
        return NULL;
    struct kiln_device_params wanted = kiln_device_defaults();
    wanted.wanted = params->device;
    wanted.gl = true; /* suites compare techniques that run in GL */
    wanted.log = params->log;
    struct kiln_bench_run run = {.params = params};
    run.device = kiln_device_open(&wanted, error);
    bool possible = run.device && check_techniques(&run, error);
    run.bench = possible ? kiln_bench_create(error) : NULL;
    bool ok = run.bench != NULL;
    if (ok) {
        double start_s = kiln_clock_seconds();
        run.bench->device = *kiln_device_get_info(run.device);
        run.bench->cores = count_cores();
        run.bench->quick = params->quick;
        run.bench->repetitions = params->quick ? KILN_BENCH_MIN_REPETITIONS : params->repetitions;
        ok = run_all(&run, error);
        run.bench->seconds = kiln_clock_seconds() - start_s;
    }
    kiln_device_close(&run.device);
    if (!ok)
        kiln_bench_destroy(&run.bench);
    return run.bench;
}
