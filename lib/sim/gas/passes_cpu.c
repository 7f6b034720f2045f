/* This file runs the passes of a substep on the host: each pass is a loop over bricks or planes in
 * threads. A piece writes only what is its own, so that threads change no bit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/pages.h"
#include "sim/gas/solver.h"

enum { BRICKS_A_PIECE = 4, PLANES_A_PIECE = 2 };

/* ---- memory ---------------------------------------------------------------------------------- */

static bool init(struct gas_solver *solver)
{
    const size_t size = kiln_threads_count(solver->threads) * sizeof *solver->spaces;
    solver->spaces = kiln_alloc_pages(size);
    if (!solver->spaces)
        return false;
    memset(solver->spaces, 0, size);
    return true;
}

static void finish(struct gas_solver *solver)
{
    free(solver->spaces);
}

static void free_window(struct gas_solver *solver)
{
    free(solver->fastest);
    free(solver->idle_changes);
    solver->fastest = solver->idle_changes = NULL;
}

static bool init_window(struct gas_solver *solver)
{
    const struct kiln_gas_place n = solver->gas->bricks;
    const size_t bricks = (size_t)n.x * (size_t)n.y * (size_t)n.z;
    solver->fastest = calloc((size_t)solver->gas->cells.z, sizeof *solver->fastest);
    if (solver->blows)
        solver->idle_changes =
            kiln_alloc_pages(bricks * GAS_IDLE_PLANES * GAS_BRICK_CELLS * sizeof(float));
    return solver->fastest && (solver->idle_changes || !solver->blows);
}

/* ---- loops ----------------------------------------------------------------------------------- */

static void join(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct gas_job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++)
        s->advect->join(job->pass, s->active.brick[i]);
}

static void trace(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct gas_job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++)
        s->advect->trace(job->pass, s->active.brick[i], &s->spaces[worker]);
}

static void react(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct gas_job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++)
        s->found[i] = s->advect->react(job->pass, s->active.brick[i], &s->spaces[worker]);
}

static void blow(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct gas_job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++) {
        const gas_brick_place at = s->pushed.brick[i];
        if (!s->gas->brick[kiln_gas_brick_index(s->gas, at.x, at.y, at.z)].chunk)
            s->advect->blow(job->pass, at, &s->spaces[worker]);
    }
}

/* Returns the smoke of a brick, summed up in the order in which gas_advect.react does. */
static double smoke_of(const struct kiln_gas_brick *brick)
{
    float column[GAS_BRICK] = {0};
    double sum = 0.0;
    for (int i = 0; i < GAS_BRICK_CELLS; i++)
        column[i % GAS_BRICK] =
            column[i % GAS_BRICK] + brick->now[(size_t)i * GAS_CARRIED + GAS_SMOKE];
    for (int x = 0; x < GAS_BRICK; x++)
        sum += (double)column[x];
    return sum;
}

static void add(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct gas_job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++) {
        const gas_brick_place at = s->active.brick[i];
        s->sourced[i] = job->hooks->add(job->hooks->context, job->pass, at);
        if (s->sourced[i])
            s->found[i].left =
                smoke_of(&s->gas->brick[kiln_gas_brick_index(s->gas, at.x, at.y, at.z)]);
    }
}

static void push(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct gas_job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t i = begin; i < end; i++)
        s->faces->push(job->pass, &s->levels.level[0], s->pushed.brick[i]);
}

static void diverge(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct gas_job *job = context;
    struct gas_solver *s = job->solver;
    s->faces->diverge(job->pass, &s->levels.level[0], (int32_t)begin, (int32_t)end);
}

static void project(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct gas_job *job = context;
    struct gas_solver *s = job->solver;
    for (size_t z = begin; z < end; z++)
        s->fastest[z] =
            s->faces->project(job->pass, &s->levels.level[0], (int32_t)z, (int32_t)z + 1);
}

/* ---- passes ---------------------------------------------------------------------------------- */

typedef void loop_body(void *context, size_t begin, size_t end, uint32_t worker);

static enum gas_failure loop(struct gas_job *job, size_t count, size_t grain, loop_body *body)
{
    return kiln_threads_try(job->solver->threads, count, grain, body, job, job->error)
               ? GAS_STEPPED
               : GAS_STOPPED;
}

static enum gas_failure over_bricks(struct gas_job *job, loop_body *body)
{
    return loop(job, job->solver->active.count, BRICKS_A_PIECE, body);
}

static enum gas_failure trace_all(struct gas_job *job)
{
    const enum gas_failure joined = over_bricks(job, join);
    return joined == GAS_STEPPED ? over_bricks(job, trace) : joined;
}

static enum gas_failure react_all(struct gas_job *job)
{
    const enum gas_failure reacted = over_bricks(job, react);
    if (reacted != GAS_STEPPED || !job->solver->blows)
        return reacted;
    return loop(job, job->solver->pushed.count, BRICKS_A_PIECE, blow);
}

static enum gas_failure add_all(struct gas_job *job)
{
    return job->hooks->add ? over_bricks(job, add) : GAS_STEPPED;
}

/* Takes the gas away from the cells that solids take at the end of a substep. */
static void empty_cells(const struct gas_pass *pass)
{
    for (size_t i = 0; i < pass->emptied_count; i++) {
        const struct gas_emptied *emptied = &pass->emptied[i];
        float *now = pass->gas->brick[emptied->brick].now;
        for (int32_t k = 0; k < GAS_BRICK_CELLS; k++)
            if (emptied->cells[k / 32] >> (k % 32) & 1)
                memset(now + (ptrdiff_t)k * GAS_CARRIED, 0, GAS_CARRIED * sizeof *now);
    }
}

static enum gas_failure move_walls(struct gas_job *job)
{
    const struct gas_hooks *hooks = job->hooks;
    if (!hooks->move_walls)
        return GAS_STEPPED;
    if (!hooks->move_walls(hooks->context, job->pass, &job->solver->levels))
        return GAS_NO_MEMORY;
    empty_cells(job->pass);
    return GAS_STEPPED;
}

/* Takes over what bricks carry beside, which sources were added to. */
static void swap_extras(struct gas_solver *s)
{
    for (uint32_t i = 0; i < s->active.count; i++) {
        const gas_brick_place at = s->active.brick[i];
        struct kiln_gas_brick *brick =
            &s->gas->brick[kiln_gas_brick_index(s->gas, at.x, at.y, at.z)];
        float *extras = brick->extras;
        brick->extras = brick->next_extras;
        brick->next_extras = extras;
    }
}

static enum gas_failure push_all(struct gas_job *job)
{
    swap_extras(job->solver);
    return loop(job, job->solver->pushed.count, BRICKS_A_PIECE, push);
}

static enum gas_failure diverge_all(struct gas_job *job)
{
    return loop(job, (size_t)job->solver->gas->cells.z, PLANES_A_PIECE, diverge);
}

static bool center(struct gas_job *job)
{
    gas_level_center(&job->solver->levels.level[0]);
    return true;
}

static bool cycle(struct gas_job *job)
{
    const struct gas_solver *s = job->solver;
    gas_levels_solve(&s->levels, s->multigrid, s->threads, job->cycles);
    return true;
}

static bool length(struct gas_job *job, bool residual, double *sum)
{
    *sum = gas_level_length(&job->solver->levels.level[0], job->solver->multigrid, residual);
    return true;
}

static enum gas_failure solve_all(struct gas_job *job)
{
    static const struct gas_pressure on_host = {.center = center, .cycle = cycle, .length = length};
    return gas_solver_find_pressure(job, &on_host) ? GAS_STEPPED : GAS_STOPPED;
}

static enum gas_failure project_all(struct gas_job *job)
{
    struct gas_solver *s = job->solver;
    const size_t planes = (size_t)s->gas->cells.z;
    const enum gas_failure projected = loop(job, planes, PLANES_A_PIECE, project);
    bool finite = true;
    s->gas->fastest = 0.0f;
    for (size_t z = 0; z < planes && projected == GAS_STEPPED; z++) {
        s->gas->fastest = fmaxf(s->gas->fastest, s->fastest[z]);
        finite = finite && isfinite(s->fastest[z]);
    }
    return finite ? projected : GAS_WRONG;
}

const struct gas_passes gas_passes_cpu = {
    .init = init,
    .finish = finish,
    .init_window = init_window,
    .free_window = free_window,
    .pass = {[GAS_TIMER_TRACE] = trace_all,
             [GAS_TIMER_REACT] = react_all,
             [GAS_TIMER_SOURCES] = add_all,
             [GAS_TIMER_WALLS] = move_walls,
             [GAS_TIMER_PUSH] = push_all,
             [GAS_TIMER_DIVERGE] = diverge_all,
             [GAS_TIMER_PRESSURE] = solve_all,
             [GAS_TIMER_PROJECT] = project_all},
};
