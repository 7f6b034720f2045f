/* Measures how a fire is drawn: how long each part of it takes, with a ray for each pixel and with
 * a grid of rays. */
#include "base/error.h"
#include "bench/gas.h"
#include "frame/stages.h"

enum { RESOLUTIONS = 2 };
static const char *const resolutions[RESOLUTIONS] = {
    [KILN_GAS_FULL] = "full", [KILN_GAS_HALF] = "half"};

/* Returns how many resolutions a drawing has. */
static int lanes_of(const struct kiln_gas_drawing *d)
{
    return d->march == KILN_MARCH_GL ? 1 : RESOLUTIONS;
}

/* Draws the fire once, by one of the resolutions. */
static bool draw(struct kiln_stages *stages, struct kiln_pool *pool, uint32_t step,
                 struct kiln_volume_costs *costs, struct kiln_error *error)
{
    uint32_t drawn = 0;
    if (!kiln_stages_draw(stages, NULL, pool, kiln_instant_at_step(step), 0, &drawn, error))
        return false;
    *costs = kiln_volume_costs(stages->volume);
    return true;
}

bool kiln_bench_draw_gas(const struct kiln_bench_run *run, struct kiln_scene *scene,
                         struct kiln_pool *pool, uint32_t step, struct kiln_threads *threads,
                         struct kiln_gas_drawing *to, struct kiln_error *error)
{
    struct kiln_stages stages;
    struct kiln_stages_params params = {.needs = {.bits = 8},
                                        .threads = threads,
                                        .timer = kiln_timer_create(NULL),
                                        .slot_count = pool->slot_count};
    struct kiln_technique_list list; /* all of them `cpu` */
    const bool in_gl = to->march == KILN_MARCH_GL;
    const char *flags[KILN_STAGE_COUNT + 1];
    for (int i = 0; i < KILN_STAGE_COUNT; i++)
        flags[i] = list.flags[i];
    flags[KILN_STAGE_COUNT] = in_gl ? "march=gl" : "march=cpu";
    if (!params.timer)
        return kiln_error_no_memory(error, "measurements");
    bool ok = kiln_techniques_combination(0, &list) &&
              kiln_techniques_choose(kiln_device_get_info(run->device), flags, KILN_STAGE_COUNT + 1,
                                     &params.techniques, error) &&
              kiln_stages_init(&stages, in_gl ? run->device : NULL, scene, &params, error);
    if (ok) {
        struct kiln_volume_costs warm;
        ok = draw(&stages, pool, step, &warm, error);
        for (; ok && to->turns < run->bench->repetitions && to->turns < KILN_GAS_TURNS; to->turns++)
            for (int i = 0; ok && i < lanes_of(to); i++) {
                scene->gas[0].look.resolution = (enum kiln_gas_resolution)i;
                ok = draw(&stages, pool, step, &to->costs[i][to->turns], error);
            }
        kiln_stages_finish(&stages);
    }
    kiln_timer_destroy(&params.timer);
    return ok;
}

/* Adds a row of a part of the drawing. */
static bool add(const struct kiln_gas_sizes *sizes, uint32_t size, const char *measure,
                const char *technique, const double *seconds, uint32_t turns,
                struct kiln_error *error)
{
    double values[KILN_GAS_TURNS];
    for (uint32_t i = 0; i < turns; i++)
        values[i] = 1e3 * seconds[i];
    return kiln_bench_add_gas(sizes, size, measure, technique, values, turns, error);
}

static bool add_drawing(const struct kiln_gas_sizes *sizes, uint32_t size,
                        const struct kiln_gas_drawing *d, struct kiln_error *error)
{
    double field[KILN_GAS_TURNS], light[KILN_GAS_TURNS], glow[KILN_GAS_TURNS];
    double march[RESOLUTIONS][KILN_GAS_TURNS];
    for (uint32_t k = 0; k < d->turns; k++) {
        field[k] = d->costs[0][k].field_s;
        light[k] = d->costs[0][k].light_s;
        glow[k] = d->costs[0][k].glow_s;
        for (int i = 0; i < lanes_of(d); i++)
            march[i][k] = d->costs[i][k].march_s;
    }
    if (!add(sizes, size, "field", "all", field, d->turns, error) ||
        !add(sizes, size, "light", "all", light, d->turns, error) ||
        !add(sizes, size, "glow", "all", glow, d->turns, error))
        return false;
    for (int i = 0; i < lanes_of(d); i++) {
        const char *lane = d->march == KILN_MARCH_GL ? "march=gl" : resolutions[i];
        const struct kiln_volume_costs *c = &d->costs[i][0];
        const double samples = c->samples > 0 ? (double)c->samples : 1.0;
        const double march_s = kiln_spread_of(march[i], d->turns).median;
        if (!add(sizes, size, "march", lane, march[i], d->turns, error) ||
            !kiln_bench_add_note(
                sizes->run->bench, error,
                "%d cells, %s: %.0f thousand rays met gas, and were sampled at %.1f "
                "million places, %.1f ns each.",
                sizes->edges[size], lane, 1e-3 * (double)c->rays, 1e-6 * samples,
                1e9 * march_s / samples))
            return false;
    }
    return true;
}

bool kiln_bench_add_drawings(const struct kiln_gas_sizes *sizes,
                             const struct kiln_gas_drawing drawings[], struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = "gas_march",
        .title = "The gas of the fire drawn at 1280x720, by part: all threads",
        .sweep = "cells along an edge",
        .unit = "ms",
    };
    bool ok = kiln_bench_begin(sizes->run, &part, error);
    for (uint32_t i = 0; ok && i < sizes->count; i++)
        ok = add_drawing(sizes, i, &drawings[i], error);
    return ok;
}
