/* This file runs a substep of a domain of gas: the passes one after another, on the host or in GL
 * (passes.h). What the bricks found is summed up here, in the order of their list. */
#include "sim/gas/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

bool gas_solver_init(struct gas_solver *solver, struct kiln_gas *gas, struct kiln_threads *threads,
                     enum kiln_simd simd)
{
    *solver = (struct gas_solver){.gas = gas,
                                  .threads = threads,
                                  .passes = &gas_passes_cpu,
                                  .advect = KILN_SIMD_PICK(kiln_gas_advect, simd),
                                  .faces = KILN_SIMD_PICK(kiln_gas_faces, simd),
                                  .multigrid = KILN_SIMD_PICK(kiln_gas_multigrid, simd)};
    return solver->passes->init(solver, NULL);
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
           bricks * (2 * sizeof(gas_brick_place) + sizeof(struct gas_found) + sizeof(double) +
                     (blows ? change : 0));
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

enum gas_failure gas_solver_step(struct gas_solver *solver, struct gas_pass *pass,
                                 const struct gas_hooks *hooks, uint32_t cycles, double residual,
                                 struct kiln_error *error)
{
    struct gas_job job = {solver, pass, hooks, cycles, residual, error};
    const size_t active = solver->active.count;
    if (active == 0)
        return GAS_STEPPED;
    memset(solver->added, 0, active * sizeof *solver->added);
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
