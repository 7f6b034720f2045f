/* This file runs a substep of a domain of gas: it places the window about the gas, wakes and frees
 * bricks, and runs the passes one after another. Each pass is a loop over bricks or planes in
 * threads; a piece writes only what is its own, and sums are added up afterwards in the order of
 * the list, so that threads change no bit. */
#include "sim/gas/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/pages.h"

enum {
    BRICKS_A_PIECE = 4,
    PLANES_A_PIECE = 2,
    TILE = 4,   /* bricks are visited in columns of so many along x and y */
    MARGIN = 2, /* bricks between active ones and the end of a new window */
    ROOMY = 3,  /* a window of so many times the volume of a new one is too large */
    IDLE_PLANES = 3,
    MOST_CYCLES = 4, /* times those that were asked for */
};

bool gas_solver_init(struct gas_solver *solver, struct kiln_gas *gas, struct kiln_threads *threads,
                     enum kiln_simd simd)
{
    *solver = (struct gas_solver){.gas = gas,
                                  .threads = threads,
                                  .advect = KILN_SIMD_PICK(kiln_gas_advect, simd),
                                  .faces = KILN_SIMD_PICK(kiln_gas_faces, simd),
                                  .multigrid = KILN_SIMD_PICK(kiln_gas_multigrid, simd)};
    const size_t size = kiln_threads_count(threads) * sizeof *solver->spaces;
    solver->spaces = kiln_alloc_pages(size);
    if (!solver->spaces)
        return false;
    memset(solver->spaces, 0, size);
    return true;
}

static void free_window(struct gas_solver *solver)
{
    gas_levels_finish(&solver->levels);
    free(solver->active.brick);
    free(solver->pushed.brick);
    free(solver->found);
    free(solver->added);
    free(solver->fastest);
    free(solver->idle_changes);
    solver->active = solver->pushed = (struct gas_list){.count = 0};
    solver->found = NULL;
    solver->added = NULL;
    solver->fastest = solver->idle_changes = NULL;
}

void gas_solver_finish(struct gas_solver *solver)
{
    free_window(solver);
    free(solver->spaces);
    *solver = (struct gas_solver){.gas = NULL};
}

static size_t brick_count(struct kiln_gas_place bricks)
{
    return (size_t)bricks.x * (size_t)bricks.y * (size_t)bricks.z;
}

uint64_t gas_solver_bytes(struct kiln_gas_place cells, bool has_walls, bool blows)
{
    const uint64_t bricks =
        (uint64_t)cells.x * (uint64_t)cells.y * (uint64_t)cells.z / GAS_BRICK_CELLS;
    const uint64_t change = sizeof(float) * IDLE_PLANES * GAS_BRICK_CELLS;
    return gas_levels_bytes(cells, has_walls) +
           bricks * (2 * sizeof(gas_brick_place) + sizeof(struct gas_found) + sizeof(double) +
                     (blows ? change : 0));
}

/* ---- the window ------------------------------------------------------------------------------ */

static bool init_window(struct gas_solver *solver)
{
    const size_t bricks = brick_count(solver->gas->bricks);
    free_window(solver);
    solver->window = solver->gas->window;
    solver->active.brick = calloc(bricks, sizeof *solver->active.brick);
    solver->pushed.brick = calloc(bricks, sizeof *solver->pushed.brick);
    solver->found = calloc(bricks, sizeof *solver->found);
    solver->added = calloc(bricks, sizeof *solver->added);
    solver->fastest = calloc((size_t)solver->gas->cells.z, sizeof *solver->fastest);
    if (solver->blows)
        solver->idle_changes =
            kiln_alloc_pages(bricks * IDLE_PLANES * GAS_BRICK_CELLS * sizeof(float));
    return solver->active.brick && solver->pushed.brick && solver->found && solver->added &&
           solver->fastest && (solver->idle_changes || !solver->blows) &&
           gas_levels_init(&solver->levels, solver->gas) &&
           (!solver->has_walls || gas_levels_add_walls(&solver->levels));
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

/* Returns the velocity of resting air across a face. cell: in the domain, the one above the face.
 */
static float rest_across(const struct gas_rest *rest, const struct kiln_gas_shape *shape, int axis,
                         struct kiln_gas_place cell)
{
    const float corner[3] = {shape->corner.x, shape->corner.y, shape->corner.z};
    const int32_t number[3] = {cell.x, cell.y, cell.z};
    float place[3]; /* m: of the face */
    for (int i = 0; i < 3; i++) {
        const float half = i == axis ? 0.0f : 0.5f;
        place[i] = corner[i] + ((float)number[i] + half) * shape->cell;
    }
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    return rest->velocity[axis] + (rest->spin[a] * place[b] - rest->spin[b] * place[a]);
}

/* Returns whether a window has a face. cell: in the domain, the one above the face. */
static bool has_face(struct kiln_gas_place at, struct kiln_gas_place cells, int axis,
                     struct kiln_gas_place cell)
{
    return cells.x > 0 && cell.x >= at.x && cell.x < at.x + cells.x + (axis == 0) &&
           cell.y >= at.y && cell.y < at.y + cells.y + (axis == 1) && cell.z >= at.z &&
           cell.z < at.z + cells.z + (axis == 2);
}

/* Sets the faces of a new window that the old one did not have. */
static void fill_rest(struct kiln_gas *gas, struct kiln_gas_place old_at, struct kiln_gas_place old,
                      const struct gas_rest *rest)
{
    const struct kiln_gas_place n = gas->cells;
    for (int axis = 0; axis < 3; axis++)
        for (int32_t z = 0; z < n.z + (axis == 2); z++)
            for (int32_t y = 0; y < n.y + (axis == 1); y++)
                for (int32_t x = 0; x < n.x + (axis == 0); x++) {
                    const struct kiln_gas_place cell = {gas->at.x + x, gas->at.y + y,
                                                        gas->at.z + z};
                    if (!has_face(old_at, old, axis, cell))
                        gas->faces[axis][z * gas->plane + y * gas->row + x] =
                            rest_across(rest, &gas->shape, axis, cell);
                }
}

static bool is_still(const struct gas_rest *rest)
{
    bool still = true;
    for (int i = 0; i < 3; i++)
        still = still && rest->velocity[i] == 0.0f && rest->spin[i] == 0.0f;
    return still;
}

static bool move_window(struct gas_solver *solver, const struct gas_region *box)
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
        return (solver->levels.count > 0 && solver->window == gas->window) || init_window(solver);
    free_window(solver); /* its pressure goes with the old window */
    if (!kiln_gas_set_window(gas, new_at, cells) || !init_window(solver))
        return false;
    if (!is_still(&solver->rest))
        fill_rest(gas, at, n, &solver->rest);
    return true;
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
        if (solver->blows)
            brick->change = solver->idle_changes + i * IDLE_PLANES * GAS_BRICK_CELLS;
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

bool gas_solver_prepare(struct gas_solver *solver, const struct gas_region *regions,
                        uint32_t region_count, bool has_walls, bool blows)
{
    struct kiln_gas *gas = solver->gas;
    const struct gas_region box = wanted_box(gas, regions, region_count);
    solver->has_walls = has_walls;
    solver->blows = blows;
    if (box.high.x <= box.low.x || box.high.y <= box.low.y || box.high.z <= box.low.z) {
        solver->active.count = solver->pushed.count = 0;
        free_window(solver);
        return gas->cells.x == 0 || kiln_gas_set_window(gas, (struct kiln_gas_place){0, 0, 0},
                                                        (struct kiln_gas_place){0, 0, 0});
    }
    if (!move_window(solver, &box))
        return false;
    uint8_t *marks = calloc(brick_count(gas->bricks), 1);
    if (!marks)
        return false;
    mark_all(gas, marks, regions, region_count);
    mark_pushed(gas, marks);
    const bool ok = list_bricks(solver, marks);
    free(marks);
    return ok;
}

/* ---- a step ---------------------------------------------------------------------------------- */

struct job {
    struct gas_solver *solver;
    struct gas_pass *pass;
    const struct gas_hooks *hooks;
};

static void join(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++)
        s->advect->join(job->pass, s->active.brick[i]);
}

static void trace(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++)
        s->advect->trace(job->pass, s->active.brick[i], &s->spaces[worker]);
}

static void react(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++)
        s->found[i] = s->advect->react(job->pass, s->active.brick[i], &s->spaces[worker]);
}

static void blow(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++) {
        const gas_brick_place at = s->pushed.brick[i];
        if (!s->gas->brick[kiln_gas_brick_index(s->gas, at.x, at.y, at.z)].chunk)
            s->advect->blow(job->pass, at, &s->spaces[worker]);
    }
}

static void add(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++)
        s->added[i] = job->hooks->add(job->hooks->context, job->pass, s->active.brick[i],
                                      &s->found[i].has_gas);
}

static void push(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++)
        s->faces->push(job->pass, &s->levels.level[0], s->pushed.brick[i]);
}

static void diverge(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct job *job = context;
    struct gas_solver *s = job->solver;
    s->faces->diverge(job->pass, &s->levels.level[0], (int32_t)begin, (int32_t)end);
}

static void project(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t z = begin; z < end; z++)
        s->fastest[z] =
            s->faces->project(job->pass, &s->levels.level[0], (int32_t)z, (int32_t)z + 1);
}

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Runs a loop of a step, and adds its time to that of a pass. False: the caller wants no more. */
static bool run(struct gas_solver *solver, enum gas_timer timer, size_t count, size_t grain,
                void (*body)(void *context, size_t begin, size_t end, uint32_t worker),
                struct job *job, struct kiln_error *error)
{
    const double begin = solver->measures ? cpu_seconds() : 0.0;
    if (!kiln_threads_try(solver->threads, count, grain, body, job, error))
        return false;
    if (solver->measures)
        solver->seconds[timer] += cpu_seconds() - begin;
    return true;
}

/* Sums up what bricks found, in the order of their list, and swaps their extras. Returns whether
 * all numbers are finite. */
static bool take_over(struct gas_solver *solver, float dt)
{
    struct kiln_gas *gas = solver->gas;
    double moved = 0.0, left = 0.0, growth = 0.0;
    bool fine = true, leaves = false;
    for (uint32_t i = 0; i < solver->active.count; i++) {
        const gas_brick_place at = solver->active.brick[i];
        const size_t index = kiln_gas_brick_index(gas, at.x, at.y, at.z);
        struct kiln_gas_brick *brick = &gas->brick[index];
        const struct gas_found *found = &solver->found[i];
        float *extras = brick->extras;
        brick->extras = brick->next_extras;
        brick->next_extras = extras;
        gas->has_gas[index] = found->has_gas;
        moved += found->moved;
        left += found->left + solver->added[i];
        growth += found->growth;
        fine = fine && !found->is_wrong;
        leaves = leaves || (gas->has_gas[index] && kiln_gas_is_at_opening(gas, at));
    }
    kiln_gas_keep_smoke(gas, moved, left, growth, dt, leaves);
    return fine;
}

/* Solves for the pressure until the residual is as small as it should be. */
static void solve(struct gas_solver *solver, uint32_t cycles, double residual)
{
    const struct gas_levels *levels = &solver->levels;
    gas_levels_solve(levels, solver->multigrid, solver->threads, cycles);
    if (residual <= 0.0)
        return;
    const double all = gas_levels_length(levels, solver->multigrid, false);
    for (uint32_t i = 0; all > 0.0; i++) {
        solver->left_over = gas_levels_length(levels, solver->multigrid, true) / all;
        if (solver->left_over <= residual || i + 1 >= MOST_CYCLES)
            break;
        gas_levels_solve(levels, solver->multigrid, solver->threads, cycles);
    }
}

static bool is_shut(const struct gas_level *level)
{
    bool shut = true;
    for (int i = 0; i < 6; i++)
        shut = shut && level->closed[i];
    return shut;
}

enum gas_failure gas_solver_step(struct gas_solver *solver, struct gas_pass *pass,
                                 const struct gas_hooks *hooks, uint32_t cycles, double residual,
                                 struct kiln_error *error)
{
    struct kiln_gas *gas = solver->gas;
    struct gas_solver *s = solver;
    struct job job = {solver, pass, hooks};
    const size_t active = s->active.count, planes = (size_t)gas->cells.z;
    if (active == 0)
        return GAS_STEPPED;
    memset(s->added, 0, active * sizeof *s->added);
    kiln_gas_closed(gas, pass->closed);
    pass->expansion = s->levels.level[0].f;
    if (!run(s, GAS_TIMER_TRACE, active, BRICKS_A_PIECE, join, &job, error) ||
        !run(s, GAS_TIMER_TRACE, active, BRICKS_A_PIECE, trace, &job, error) ||
        !run(s, GAS_TIMER_REACT, active, BRICKS_A_PIECE, react, &job, error) ||
        (s->blows && !run(s, GAS_TIMER_REACT, s->pushed.count, BRICKS_A_PIECE, blow, &job, error)))
        return GAS_STOPPED;
    if (hooks->add && !run(s, GAS_TIMER_SOURCES, active, BRICKS_A_PIECE, add, &job, error))
        return GAS_STOPPED;
    const double begin = s->measures ? cpu_seconds() : 0.0;
    if (hooks->move_walls && !hooks->move_walls(hooks->context, pass, &s->levels))
        return GAS_NO_MEMORY;
    s->seconds[GAS_TIMER_WALLS] += s->measures ? cpu_seconds() - begin : 0.0;
    if (!run(s, GAS_TIMER_PUSH, s->pushed.count, BRICKS_A_PIECE, push, &job, error))
        return GAS_STOPPED;
    if (!take_over(s, pass->step->dt))
        return GAS_WRONG; /* before pressure takes it to all cells */
    if (!run(s, GAS_TIMER_DIVERGE, planes, PLANES_A_PIECE, diverge, &job, error))
        return GAS_STOPPED;
    if (is_shut(&s->levels.level[0]))
        gas_levels_center(&s->levels);
    const double solving = s->measures ? cpu_seconds() : 0.0;
    solve(s, cycles, residual);
    s->seconds[GAS_TIMER_PRESSURE] += s->measures ? cpu_seconds() - solving : 0.0;
    if (!run(s, GAS_TIMER_PROJECT, planes, PLANES_A_PIECE, project, &job, error))
        return GAS_STOPPED;
    gas->fastest = 0.0f;
    bool finite = true;
    for (size_t z = 0; z < planes; z++) {
        gas->fastest = fmaxf(gas->fastest, s->fastest[z]);
        finite = finite && isfinite(s->fastest[z]);
    }
    return finite ? GAS_STEPPED : GAS_WRONG;
}

bool gas_solver_find_wrong(const struct gas_solver *solver, struct kiln_gas_place *cell)
{
    const struct kiln_gas *gas = solver->gas;
    const struct kiln_gas_place n = gas->cells;
    for (int32_t z = 0; z < n.z; z++)
        for (int32_t y = 0; y < n.y; y++)
            for (int32_t x = 0; x < n.x; x++) {
                const float *now = gas->brick[kiln_gas_brick_index(gas, x / GAS_BRICK,
                                                                   y / GAS_BRICK, z / GAS_BRICK)]
                                       .now;
                const int32_t at =
                    (z % GAS_BRICK * GAS_BRICK + y % GAS_BRICK) * GAS_BRICK + x % GAS_BRICK;
                float sum = 0.0f;
                for (int c = 0; c < 3; c++)
                    sum += 0.0f * gas->faces[c][z * gas->plane + y * gas->row + x];
                for (int c = 0; c < GAS_CARRIED && now; c++)
                    sum += 0.0f * now[at * GAS_CARRIED + c];
                *cell = (struct kiln_gas_place){gas->at.x + x, gas->at.y + y, gas->at.z + z};
                if (!isfinite(sum))
                    return true;
            }
    return false;
}
