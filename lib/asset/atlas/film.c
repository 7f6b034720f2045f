/* This file runs the gas of a procedural flipbook and records it at the times of the flipbook's
 * cells. builtin.c makes a film whenever an atlas with such a flipbook is made. The gas takes the
 * same steps for any number of cells, and a cell whose time lies between two steps is interpolated
 * from both. So the gas looks the same at the same time, however many cells record it. The motion
 * of a cell is the velocity of the gas, integrated from the cell's time to that of the next. */
#include "asset/atlas/film.h"

#include <stdlib.h>
#include <string.h>

#include "shared/exact.h"

enum { STEPS = 126 }; /* in the life of a particle: two from each of 64 cells to the next */

/* Holds a copy, made before a step, of the fields of the gas that go into a cell. */
struct fields {
    float heat[KILN_FLUID_SIZE];
    float place_x[KILN_FLUID_SIZE], place_y[KILN_FLUID_SIZE];
};

static void copy_fields(const struct kiln_fluid *fluid, struct fields *before)
{
    memcpy(before->heat, fluid->heat, sizeof before->heat);
    memcpy(before->place_x, fluid->place_x, sizeof before->place_x);
    memcpy(before->place_y, fluid->place_y, sizeof before->place_y);
}

static void mix(const float *from, const float *to, float part, float *out)
{
    for (uint32_t i = 0; i < KILN_FLUID_SIZE; i++)
        out[i] = from[i] + part * (to[i] - from[i]);
}

/* Computes the weights of a cell, which are large for hot gas, and multiplies the places by them
 * (film.h). The places are divided by the weights later, so a weight is never 0. */
static void weigh(struct kiln_film_cell *cell)
{
    for (uint32_t i = 0; i < KILN_FLUID_SIZE; i++) {
        float heat_squared = cell->heat[i] * cell->heat[i];
        cell->weight[i] = heat_squared * heat_squared + 1e-6f;
        cell->place_x[i] *= cell->weight[i];
        cell->place_y[i] *= cell->weight[i];
    }
}

/* Returns the number of steps until the time of a cell; it need not be whole. */
static float step_of(const struct kiln_film *film, uint32_t cell)
{
    uint32_t gaps = film->cell_count > 1 ? film->cell_count - 1 : 1;
    return (float)(cell * STEPS) / (float)gaps;
}

/* Records the cells whose times lie in the step, from cell `next` on. Returns the first cell that
 * is not recorded. step: number of the step that was made last; before: the fields before it. */
static uint32_t record(const struct kiln_fluid *fluid, const struct fields *before, float step,
                       struct kiln_film *film, uint32_t next)
{
    while (next < film->cell_count && step_of(film, next) <= step + 1.0f) {
        struct kiln_film_cell *cell = &film->cells[next];
        float part = step_of(film, next) - step;
        cell->time = step_of(film, next) / STEPS;
        mix(before->heat, fluid->heat, part, cell->heat);
        mix(before->place_x, fluid->place_x, part, cell->place_x);
        mix(before->place_y, fluid->place_y, part, cell->place_y);
        weigh(cell);
        next++;
    }
    return next;
}

/* Adds the motion during a step to each cell from which the way to the next cell falls into the
 * step, wholly or in part. */
static void add_motion(const struct kiln_fluid *fluid, float step, struct kiln_film *film)
{
    for (uint32_t k = 0; k + 1 < film->cell_count; k++) {
        float from = exact_max(step, step_of(film, k));
        float to = exact_min(step + 1.0f, step_of(film, k + 1));
        if (to <= from)
            continue;
        float duration = (to - from) / STEPS;
        for (uint32_t i = 0; i < KILN_FLUID_SIZE; i++) {
            film->cells[k].motion_x[i] += duration * fluid->velocity_x[i];
            film->cells[k].motion_y[i] += duration * fluid->velocity_y[i];
        }
    }
}

static void run(const struct kiln_film_gas *gas, const struct kiln_fluid_code *code,
                struct kiln_fluid *fluid, struct fields *before, struct kiln_film *film)
{
    const float dt = 1.0f / STEPS;
    uint32_t next = 0;
    for (uint32_t step = 0; next < film->cell_count; step++) {
        copy_fields(fluid, before);
        if (gas->drive)
            gas->drive(fluid, (float)step * dt, dt);
        code->step(fluid, dt);
        next = record(fluid, before, (float)step, film, next);
        add_motion(fluid, (float)step, film);
    }
}

uint64_t kiln_film_bytes(uint32_t cell_count)
{
    const struct kiln_film *film = NULL;
    return sizeof *film + (uint64_t)cell_count * sizeof film->cells[0];
}

struct kiln_film *kiln_film_create(const struct kiln_film_gas *gas,
                                   const struct kiln_fluid_code *code, uint32_t cell_count)
{
    struct kiln_fluid *fluid = aligned_alloc(alignof(struct kiln_fluid), sizeof *fluid);
    struct fields *before = malloc(sizeof *before);
    struct kiln_film *film = calloc(1, kiln_film_bytes(cell_count));
    if (film && fluid && before) {
        film->cell_count = cell_count;
        kiln_fluid_init(fluid);
        if (gas->start)
            gas->start(fluid);
        run(gas, code, fluid, before, film);
    } else {
        free(film);
        film = NULL;
    }
    free(before);
    free(fluid);
    return film;
}
