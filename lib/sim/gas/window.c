/* This file places the window of a domain about its gas, and wakes and frees bricks, before each
 * substep. */
#include <stdlib.h>

#include "sim/gas/new_air.h"
#include "sim/gas/solver.h"

enum {
    TILE = 4,   /* bricks are visited in columns of so many along x and y */
    MARGIN = 2, /* bricks between active ones and the end of a new window */
    ROOMY = 3,  /* a window of so many times the volume of a new one is too large */
};

static size_t brick_count(struct kiln_gas_place bricks)
{
    return (size_t)bricks.x * (size_t)bricks.y * (size_t)bricks.z;
}

/* ---- the window ------------------------------------------------------------------------------ */

void gas_solver_free_window(struct gas_solver *solver)
{
    if (solver->passes)
        solver->passes->free_window(solver);
    gas_levels_finish(&solver->levels);
    free(solver->active.brick);
    free(solver->pushed.brick);
    free(solver->found);
    free(solver->sourced);
    solver->active = solver->pushed = (struct gas_list){.count = 0};
    solver->found = NULL;
    solver->sourced = NULL;
}

static bool init_window(struct gas_solver *solver)
{
    const size_t bricks = brick_count(solver->gas->bricks);
    gas_solver_free_window(solver);
    solver->window = solver->gas->window;
    solver->active.brick = calloc(bricks, sizeof *solver->active.brick);
    solver->pushed.brick = calloc(bricks, sizeof *solver->pushed.brick);
    solver->found = calloc(bricks, sizeof *solver->found);
    solver->sourced = calloc(bricks, sizeof *solver->sourced);
    return solver->active.brick && solver->pushed.brick && solver->found && solver->sourced &&
           gas_levels_init(&solver->levels, solver->gas) &&
           (!solver->has_walls || gas_levels_add_walls(&solver->levels)) &&
           solver->passes->init_window(solver);
}

static void include(struct gas_region *box, struct kiln_gas_place low, struct kiln_gas_place high)
{
    box->low.x = low.x < box->low.x ? low.x : box->low.x;
    box->low.y = low.y < box->low.y ? low.y : box->low.y;
    box->low.z = low.z < box->low.z ? low.z : box->low.z;
    box->high.x = high.x > box->high.x ? high.x : box->high.x;
    box->high.y = high.y > box->high.y ? high.y : box->high.y;
    box->high.z = high.z > box->high.z ? high.z : box->high.z;
}

/* Returns the box, in bricks of the domain, of all that is going to be active; empty: nothing is.
 */
static struct gas_region wanted_box(const struct kiln_gas *gas, const struct gas_region *regions,
                                    uint32_t region_count)
{
    struct gas_region box = {{INT32_MAX, INT32_MAX, INT32_MAX}, {INT32_MIN, INT32_MIN, INT32_MIN}};
    const struct kiln_gas_place n = gas->bricks, all = gas->shape.cells;
    for (int32_t z = 0; z < n.z; z++)
        for (int32_t y = 0; y < n.y; y++)
            for (int32_t x = 0; x < n.x; x++) {
                const struct kiln_gas_place at = {gas->at.x / GAS_BRICK + x,
                                                  gas->at.y / GAS_BRICK + y,
                                                  gas->at.z / GAS_BRICK + z};
                if (gas->has_gas[kiln_gas_brick_index(gas, x, y, z)])
                    include(&box, (struct kiln_gas_place){at.x - 1, at.y - 1, at.z - 1},
                            (struct kiln_gas_place){at.x + 2, at.y + 2, at.z + 2});
            }
    for (uint32_t i = 0; i < region_count; i++)
        include(&box, regions[i].low, regions[i].high);
    const struct kiln_gas_place end = {all.x / GAS_BRICK, all.y / GAS_BRICK, all.z / GAS_BRICK};
    box.low = (struct kiln_gas_place){box.low.x < 0 ? 0 : box.low.x, box.low.y < 0 ? 0 : box.low.y,
                                      box.low.z < 0 ? 0 : box.low.z};
    box.high = (struct kiln_gas_place){box.high.x > end.x ? end.x : box.high.x,
                                       box.high.y > end.y ? end.y : box.high.y,
                                       box.high.z > end.z ? end.z : box.high.z};
    return box;
}

/* Returns cells of a window along an axis: at least as many as wanted, a multiple of the stride,
 * and a small number times a power of two, so that the multigrid has many levels. */
static int32_t good_size(int32_t wanted)
{
    int32_t stride = KILN_GAS_STRIDE;
    while ((wanted + stride - 1) / stride > 8)
        stride *= 2;
    return (wanted + stride - 1) / stride * stride;
}

/* Places a window along an axis about bricks [low, high), with a margin, in a domain of `all`
 * cells.
 */
static void place_window(int32_t low, int32_t high, int32_t all, int32_t *at, int32_t *cells)
{
    const int32_t stride = KILN_GAS_STRIDE;
    int32_t begin = (low - MARGIN) * GAS_BRICK, end = (high + MARGIN) * GAS_BRICK;
    begin = begin < 0 ? 0 : begin / stride * stride;
    end = end > all ? all : (end + stride - 1) / stride * stride;
    const int32_t size = good_size(end - begin);
    if (size >= all) {
        begin = 0;
        end = all;
    } else {
        begin -= (size - (end - begin)) / 2 / stride * stride;
        begin = begin < 0 ? 0 : begin + size > all ? all - size : begin;
        end = begin + size;
    }
    *at = begin;
    *cells = end - begin;
}

/* A window is good if the box lies in it, not at an end that could be farther out. */
static bool fits(int32_t low, int32_t high, int32_t at, int32_t cells, int32_t all)
{
    const int32_t begin = low * GAS_BRICK, end = high * GAS_BRICK;
    return (begin > at || (begin == at && at == 0)) &&
           (end < at + cells || (end == at + cells && end == all));
}

static bool is_closed(const struct kiln_gas_shape *shape)
{
    bool closed = true;
    for (int i = 0; i < 6; i++)
        closed = closed && shape->closed[i];
    return closed;
}

static enum gas_failure move_window(struct gas_solver *solver, const struct gas_region *box,
                                    struct kiln_error *error)
{
    struct kiln_gas *gas = solver->gas;
    const struct kiln_gas_place all = gas->shape.cells, at = gas->at, n = gas->cells;
    struct kiln_gas_place new_at = {0, 0, 0}, cells = all;
    const bool closed = is_closed(&gas->shape); /* all of a closed room flows */
    if (!closed) {
        place_window(box->low.x, box->high.x, all.x, &new_at.x, &cells.x);
        place_window(box->low.y, box->high.y, all.y, &new_at.y, &cells.y);
        place_window(box->low.z, box->high.z, all.z, &new_at.z, &cells.z);
    }
    const bool good = n.x > 0 && fits(box->low.x, box->high.x, at.x, n.x, all.x) &&
                      fits(box->low.y, box->high.y, at.y, n.y, all.y) &&
                      fits(box->low.z, box->high.z, at.z, n.z, all.z);
    const double volume = (double)n.x * (double)n.y * (double)n.z;
    if (good && (closed || volume <= ROOMY * ((double)cells.x * (double)cells.y * (double)cells.z)))
        return (solver->levels.count > 0 && solver->window == gas->window) || init_window(solver)
                   ? GAS_STEPPED
                   : GAS_NO_MEMORY;
    if (!kiln_gas_fetch(gas, error))
        return GAS_STOPPED;
    gas_solver_free_window(solver); /* its pressure goes with the old window */
    if (!kiln_gas_set_window(gas, new_at, cells) || !init_window(solver))
        return GAS_NO_MEMORY;
    solver->reached = true;
    solver->old_at = at;
    solver->old_cells = n;
    gas_new_air_rest(gas, at, n, &solver->rest);
    return GAS_STEPPED;
}

/* ---- active bricks --------------------------------------------------------------------------- */

enum { WAKES = 1, PUSHED = 2 };

/* Marks bricks of the window from `low` to before `high`. */
static void mark(const struct kiln_gas *gas, uint8_t *marks, struct kiln_gas_place low,
                 struct kiln_gas_place high, uint8_t bit)
{
    const struct kiln_gas_place n = gas->bricks;
    for (int32_t z = low.z < 0 ? 0 : low.z; z < high.z && z < n.z; z++)
        for (int32_t y = low.y < 0 ? 0 : low.y; y < high.y && y < n.y; y++)
            for (int32_t x = low.x < 0 ? 0 : low.x; x < high.x && x < n.x; x++)
                marks[kiln_gas_brick_index(gas, x, y, z)] |= bit;
}

static void mark_all(const struct kiln_gas *gas, uint8_t *marks, const struct gas_region *regions,
                     uint32_t region_count)
{
    const struct kiln_gas_place n = gas->bricks;
    const struct kiln_gas_place from = {gas->at.x / GAS_BRICK, gas->at.y / GAS_BRICK,
                                        gas->at.z / GAS_BRICK};
    for (int32_t z = 0; z < n.z; z++)
        for (int32_t y = 0; y < n.y; y++)
            for (int32_t x = 0; x < n.x; x++)
                if (gas->has_gas[kiln_gas_brick_index(gas, x, y, z)])
                    mark(gas, marks, (struct kiln_gas_place){x - 1, y - 1, z - 1},
                         (struct kiln_gas_place){x + 2, y + 2, z + 2}, WAKES);
    for (uint32_t i = 0; i < region_count; i++) {
        const struct gas_region *r = &regions[i];
        mark(gas, marks,
             (struct kiln_gas_place){r->low.x - from.x, r->low.y - from.y, r->low.z - from.z},
             (struct kiln_gas_place){r->high.x - from.x, r->high.y - from.y, r->high.z - from.z},
             WAKES);
    }
}

/* Lists a brick if it is active or pushed, and gives it what it then needs. */
static bool list_brick(struct gas_solver *solver, const uint8_t *marks, gas_brick_place at)
{
    struct kiln_gas *gas = solver->gas;
    const size_t i = kiln_gas_brick_index(gas, at.x, at.y, at.z);
    struct kiln_gas_brick *brick = &gas->brick[i];
    if (marks[i] & WAKES) {
        if (!kiln_gas_brick_take(gas, brick))
            return false;
        solver->active.brick[solver->active.count++] = at;
    } else {
        kiln_gas_brick_free(gas, brick);
        gas->has_gas[i] = 0;
        if (solver->idle_changes)
            brick->change = solver->idle_changes + i * GAS_IDLE_PLANES * GAS_BRICK_CELLS;
    }
    if (marks[i] || solver->blows)
        solver->pushed.brick[solver->pushed.count++] = at;
    return true;
}

/* Lists bricks in an order in which neighbours follow each other soon. */
static bool list_bricks(struct gas_solver *solver, const uint8_t *marks)
{
    const struct kiln_gas_place n = solver->gas->bricks;
    solver->active.count = solver->pushed.count = 0;
    for (int32_t yt = 0; yt < n.y; yt += TILE)
        for (int32_t xt = 0; xt < n.x; xt += TILE)
            for (int32_t z = 0; z < n.z; z++)
                for (int32_t y = yt; y < n.y && y < yt + TILE; y++)
                    for (int32_t x = xt; x < n.x && x < xt + TILE; x++)
                        if (!list_brick(solver, marks, (gas_brick_place){x, y, z}))
                            return false;
    return true;
}

/* Marks the bricks behind active ones, whose lower faces they share. */
static void mark_pushed(const struct kiln_gas *gas, uint8_t *marks)
{
    const struct kiln_gas_place n = gas->bricks;
    for (int32_t z = 0; z < n.z; z++)
        for (int32_t y = 0; y < n.y; y++)
            for (int32_t x = 0; x < n.x; x++) {
                const size_t i = kiln_gas_brick_index(gas, x, y, z);
                const size_t row = (size_t)n.x, plane = row * (size_t)n.y;
                if ((x && marks[i - 1] & WAKES) || (y && marks[i - row] & WAKES) ||
                    (z && marks[i - plane] & WAKES))
                    marks[i] |= PUSHED;
            }
}

enum gas_failure gas_solver_prepare(struct gas_solver *solver, const struct gas_region *regions,
                                    uint32_t region_count, bool has_walls, bool blows,
                                    struct kiln_error *error)
{
    static const struct kiln_gas_place none = {0, 0, 0};
    struct kiln_gas *gas = solver->gas;
    const struct gas_region box = wanted_box(gas, regions, region_count);
    solver->has_walls = has_walls;
    solver->blows = blows;
    solver->reached = false;
    if (box.high.x <= box.low.x || box.high.y <= box.low.y || box.high.z <= box.low.z) {
        solver->active.count = solver->pushed.count = 0;
        gas_solver_free_window(solver);
        return gas->cells.x == 0 || kiln_gas_set_window(gas, none, none) ? GAS_STEPPED
                                                                         : GAS_NO_MEMORY;
    }
    const enum gas_failure moved = move_window(solver, &box, error);
    if (moved != GAS_STEPPED)
        return moved;
    uint8_t *marks = calloc(brick_count(gas->bricks), 1);
    if (!marks)
        return GAS_NO_MEMORY;
    mark_all(gas, marks, regions, region_count);
    mark_pushed(gas, marks);
    const bool ok = list_bricks(solver, marks);
    free(marks);
    return ok ? GAS_STEPPED : GAS_NO_MEMORY;
}
