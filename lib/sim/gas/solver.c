/* This file runs a substep of a domain of gas: the passes one after another, on the host or in GL
 * (passes.h). What the bricks found is summed up here, in the order of their list. */
#include "sim/gas/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

bool gas_solver_init(struct gas_solver *solver, struct kiln_gas *gas, struct kiln_threads *threads,
                     enum kiln_simd simd, struct gas_kernels *kernels)
{
    *solver = (struct gas_solver){.gas = gas,
                                  .threads = threads,
                                  .passes = kernels ? &gas_passes_gl : &gas_passes_cpu,
                                  .kernels = kernels,
                                  .advect = KILN_SIMD_PICK(kiln_gas_advect, simd),
                                  .faces = KILN_SIMD_PICK(kiln_gas_faces, simd),
                                  .multigrid = KILN_SIMD_PICK(kiln_gas_multigrid, simd)};
    return solver->passes->init(solver);
}

void gas_solver_finish(struct gas_solver *solver)
{
    gas_solver_free_window(solver);
    solver->passes->finish(solver);
    *solver = (struct gas_solver){.gas = NULL};
}

uint64_t gas_solver_bytes(struct kiln_gas_place cells, bool has_walls, bool blows)
{
    const uint64_t bricks =
        (uint64_t)cells.x * (uint64_t)cells.y * (uint64_t)cells.z / GAS_BRICK_CELLS;
    const uint64_t change = sizeof(float) * GAS_IDLE_PLANES * GAS_BRICK_CELLS;
    return gas_levels_bytes(cells, has_walls) +
           bricks * (2 * sizeof(gas_brick_place) + sizeof(struct gas_found) + sizeof(bool) +
                     (blows ? change : 0));
}

/* Sets a group of what cells carry beside to 0. */
static void clear_group(struct gas_solver *solver, uint32_t group)
{
    const struct kiln_gas *gas = solver->gas;
    const size_t words = (size_t)GAS_BRICK_CELLS * GAS_CARRIED;
    for (size_t i = 0; i < (size_t)gas->bricks.x * (size_t)gas->bricks.y * (size_t)gas->bricks.z;
         i++)
        if (gas->brick[i].extras)
            memset(gas->brick[i].extras + group * words, 0, words * sizeof(float));
    if (solver->passes->clear_group)
        solver->passes->clear_group(solver, group);
}

void gas_solver_begin_ways(struct gas_solver *solver, float start_s, float end_s)
{
    const struct kiln_gas_shape *shape = &solver->gas->shape;
    for (uint32_t group = 0; shape->detailed && group < 2; group++)
        if (kiln_gas_way_phase(group, end_s) < kiln_gas_way_phase(group, start_s))
            clear_group(solver, kiln_gas_group(shape, GAS_CAME_FROM) + group);
}

/* ---- a step ---------------------------------------------------------------------------------- */

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Runs a pass, and adds its time. */
static enum gas_failure run(struct gas_job *job, enum gas_timer timer)
{
    struct gas_solver *solver = job->solver;
    const double begin = solver->measures ? cpu_seconds() : 0.0;
    const enum gas_failure failure = solver->passes->pass[timer](job);
    if (solver->measures)
        solver->seconds[timer] += cpu_seconds() - begin;
    return failure;
}

/* Sums up what bricks found, in the order of their list. Returns whether all numbers are finite. */
static bool take_over(struct gas_solver *solver, float dt)
{
    struct kiln_gas *gas = solver->gas;
    double moved = 0.0, left = 0.0, growth = 0.0;
    bool fine = true, leaves = false;
    for (uint32_t i = 0; i < solver->active.count; i++) {
        const gas_brick_place at = solver->active.brick[i];
        const size_t index = kiln_gas_brick_index(gas, at.x, at.y, at.z);
        const struct gas_found *found = &solver->found[i];
        gas->has_gas[index] = found->has_gas || solver->sourced[i];
        moved += found->moved;
        left += found->left;
        growth += found->growth;
        fine = fine && !found->is_wrong;
        leaves = leaves || (gas->has_gas[index] && kiln_gas_is_at_opening(gas, at));
    }
    kiln_gas_keep_smoke(gas, moved, left, growth, dt, leaves);
    return fine;
}

static bool is_shut(const struct gas_level *level)
{
    bool shut = true;
    for (int i = 0; i < 6; i++)
        shut = shut && level->closed[i];
    return shut;
}

bool gas_solver_find_pressure(struct gas_job *job, const struct gas_pressure *pressure)
{
    struct gas_solver *s = job->solver;
    double all = 0.0, left = 0.0;
    if ((is_shut(&s->levels.level[0]) && !pressure->center(job)) || !pressure->cycle(job))
        return false;
    if (job->residual <= 0.0)
        return true;
    if (!pressure->length(job, false, &all))
        return false;
    for (uint32_t i = 0; all > 0.0; i++) {
        if (!pressure->length(job, true, &left))
            return false;
        s->left_over = left / all;
        if (s->left_over <= job->residual || i + 1 >= GAS_MOST_CYCLES)
            break;
        if (!pressure->cycle(job))
            return false;
    }
    return true;
}

enum gas_failure gas_solver_step(struct gas_solver *solver, struct gas_pass *pass,
                                 const struct gas_hooks *hooks, uint32_t cycles, double residual,
                                 struct kiln_error *error)
{
    struct gas_job job = {solver, pass, hooks, cycles, residual, error};
    const size_t active = solver->active.count;
    if (active == 0)
        return GAS_STEPPED;
    memset(solver->sourced, 0, active * sizeof *solver->sourced);
    kiln_gas_closed(solver->gas, pass->closed);
    pass->expansion = solver->levels.level[0].f;
    for (int timer = 0; timer < GAS_TIMERS; timer++) {
        const enum gas_failure failure = run(&job, (enum gas_timer)timer);
        if (failure != GAS_STEPPED)
            return failure;
        /* before pressure takes what is wrong to all cells */
        if (timer == GAS_TIMER_PUSH && !take_over(solver, pass->step->dt))
            return GAS_WRONG;
    }
    return GAS_STEPPED;
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
