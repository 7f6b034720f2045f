/* This file sets up the sweeps that take the light of the sun and of the sky through a domain of
 * gas. Slices are planes of cells across the axis that is closest to the light's direction, so a
 * slice reads its neighbours in the slice before it alone. */
#include "draw/volume/volume_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/pages.h"
#include "shared/exact.h"

/* Directions to the sky, in parts of the way upwards; the mean of their light counts. */
static const float SKY[VOLUME_SKY_WAYS][3] = {
    {0.0f, 1.0f, 0.0f}, {0.9f, 1.0f, 0.1f},   {-0.9f, 1.0f, 0.2f},
    {0.1f, 1.0f, 0.9f}, {-0.2f, 1.0f, -0.9f},
};

static size_t slice_floats(const int32_t count[3])
{
    return (size_t)(count[0] + 2 * VOLUME_SLICE_MARGIN) * (size_t)(count[1] + 4);
}

uint64_t kiln_volume_slices_bytes(struct kiln_gas_place cells)
{
    const int32_t level[3] = {cells.x, cells.z, cells.y};
    return (uint64_t)2 * VOLUME_SKY_WAYS * slice_floats(level) * sizeof(float);
}

/* Returns the axis along which a direction is longest. */
static int longest_axis(const float way[3])
{
    const int first = fabsf(way[0]) > fabsf(way[1]) ? 0 : 1;
    return fabsf(way[2]) > fabsf(way[first]) ? 2 : first;
}

static struct kiln_volume_sweep make_sweep(const struct kiln_volume_field *field, int slices)
{
    const int axis[3] = {slices == 0 ? 1 : 0, slices == 2 ? 1 : 2, slices};
    const int32_t cells[3] = {field->cells.x, field->cells.y, field->cells.z};
    const ptrdiff_t bricks[3] = {1, field->bricks.x, (ptrdiff_t)field->bricks.x * field->bricks.y};
    const ptrdiff_t cell[3] = {GAS_CARRIED, (ptrdiff_t)GAS_CARRIED * GAS_BRICK,
                               (ptrdiff_t)GAS_CARRIED * GAS_BRICK * GAS_BRICK};
    const ptrdiff_t drawn[3] = {VOLUME_CELL, VOLUME_ROW, VOLUME_PLANE};
    struct kiln_volume_sweep sweep = {.field = field};
    for (int i = 0; i < 3; i++) {
        sweep.count[i] = cells[axis[i]];
        sweep.brick[i] = bricks[axis[i]];
        sweep.cell[i] = cell[axis[i]];
        sweep.drawn[i] = drawn[axis[i]];
    }
    sweep.pitch = sweep.count[0] + 2 * VOLUME_SLICE_MARGIN;
    return sweep;
}

/* Adds a direction to a sweep. slices: the axis of the slices. */
static void add_way(struct kiln_volume_sweep *sweep, const float way[3], int slices,
                    float thickness)
{
    struct kiln_volume_way *w = &sweep->ways[sweep->way_count++];
    const float along = fabsf(way[slices]);
    const float lanes = way[slices == 0 ? 1 : 0] / along, rows = way[slices == 2 ? 1 : 2] / along;
    const float length = sqrtf(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]) / along;
    w->lanes = exact_int(floorf(lanes));
    w->rows = exact_int(floorf(rows));
    w->lane_part = lanes - (float)w->lanes;
    w->row_part = rows - (float)w->rows;
    w->half = 0.5f * thickness * length;
}

static bool open_slices(struct kiln_volume_slices *slices, struct kiln_volume_sweep *sweep,
                        struct kiln_error *error)
{
    const size_t floats = slice_floats(sweep->count), all = (size_t)2 * sweep->way_count * floats;
    if (all > slices->room) {
        free(slices->floats);
        slices->floats = kiln_alloc_pages(all * sizeof *slices->floats);
        slices->room = slices->floats ? all : 0;
    }
    if (!slices->floats)
        return kiln_error_no_memory(error, "the light of gas");
    memset(slices->floats, 0, all * sizeof *slices->floats);
    const size_t first = VOLUME_SLICE_MARGIN + 2 * (size_t)sweep->pitch;
    for (size_t i = 0; i < sweep->way_count; i++) {
        sweep->ways[i].before = slices->floats + 2 * i * floats + first;
        sweep->ways[i].here = sweep->ways[i].before + floats;
    }
    return true;
}

struct sweep_job {
    const struct kiln_volume_sweep *sweep;
    const struct kiln_volume_light_rows *rows;
    int32_t slice;
};

static void sweep_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct sweep_job *job = context;
    for (size_t row = begin; row < end; row++)
        job->rows->sweep(job->sweep, job->slice, (int32_t)row);
}

/* Visits the slices, from the last one down if the light comes from there. */
static bool run_sweep(struct kiln_volume_slices *slices, struct kiln_volume_sweep *sweep, bool down,
                      const struct kiln_volume_light_rows *rows, struct kiln_threads *threads,
                      struct kiln_error *error)
{
    if (!open_slices(slices, sweep, error))
        return false;
    for (int32_t i = 0; i < sweep->count[2]; i++) {
        struct sweep_job job = {sweep, rows, down ? sweep->count[2] - 1 - i : i};
        if (!kiln_threads_try(threads, (size_t)sweep->count[1], 16, sweep_rows, &job, error))
            return false;
        for (uint32_t w = 0; w < sweep->way_count; w++) {
            struct kiln_volume_way *way = &sweep->ways[w];
            float *before = way->before;
            way->before = way->here;
            way->here = before;
        }
    }
    return true;
}

bool kiln_volume_light_run(struct kiln_volume_slices *slices, const struct kiln_volume_field *field,
                           const struct kiln_volume_light *light,
                           const struct kiln_volume_light_rows *rows, struct kiln_threads *threads,
                           struct kiln_error *error)
{
    if (light->sun) {
        const int axis = longest_axis(light->to_sun);
        struct kiln_volume_sweep sweep = make_sweep(field, axis);
        sweep.sun = true;
        add_way(&sweep, light->to_sun, axis, light->thickness);
        if (!run_sweep(slices, &sweep, light->to_sun[axis] > 0.0f, rows, threads, error))
            return false;
    }
    if (!light->sky)
        return true;
    struct kiln_volume_sweep sweep = make_sweep(field, 1);
    for (int i = 0; i < VOLUME_SKY_WAYS; i++)
        add_way(&sweep, SKY[i], 1, light->thickness);
    return run_sweep(slices, &sweep, true, rows, threads, error);
}
