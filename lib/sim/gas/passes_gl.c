/* This file runs the passes of a substep in GL, by the kernels of shaders/sim/gas. The host still
 * finds out how far cells lie in sources and in solids, the forces at the points of their lattice,
 * and what the bricks found in all; it sends the former, and reads the latter back. */
#include "sim/gas/passes_gl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"

/* ---- memory ---------------------------------------------------------------------------------- */

static bool init(struct gas_solver *solver)
{
    solver->fields = calloc(1, sizeof *solver->fields);
    if (solver->fields)
        gas_fields_init(solver->fields, solver->kernels, solver->gas);
    return solver->fields != NULL;
}

static void finish(struct gas_solver *solver)
{
    if (solver->fields)
        gas_fields_finish(solver->fields);
    free(solver->fields);
}

/* The window is filled in the next substep. */
static bool init_window(struct gas_solver *solver)
{
    (void)solver;
    return true;
}

static void free_window(struct gas_solver *solver)
{
    gas_fields_free_window(solver->fields);
}

/* A gas that has another window by now, from a saved state, is on the host alone. */
static void clear_group(struct gas_solver *solver, uint32_t group)
{
    if (solver->window == solver->gas->window)
        gas_fields_clear_group(solver->fields, group);
}

/* ---- kernels --------------------------------------------------------------------------------- */

static bool binds(struct gas_job *job, GLuint at, enum gas_field field, bool written)
{
    return gas_fields_bind(job->solver->fields, at, field, written, job->error);
}

static bool reads(struct gas_job *job, GLuint at, enum gas_field field)
{
    return binds(job, at, field, false);
}

static bool writes(struct gas_job *job, GLuint at, enum gas_field field)
{
    return binds(job, at, field, true);
}

/* Runs a kernel: so many invocations for each brick of a list. */
static bool run_list(struct gas_job *job, enum gas_kernel kernel, struct gas_listed list,
                     uint32_t invocations)
{
    struct gas_kernels *kernels = job->solver->kernels;
    if (list.count == 0)
        return true;
    if (!gas_kernels_use(kernels, kernel, job->error))
        return false;
    glUniform1ui(GAS_AT_FIRST, list.first);
    gas_kernels_dispatch(kernels, list.count * invocations);
    return true;
}

static uint32_t cells_of_window(const struct kiln_gas *gas)
{
    return (uint32_t)gas->cells.x * (uint32_t)gas->cells.y * (uint32_t)gas->cells.z;
}

/* Runs a kernel for each cell of the window. */
static bool run_all(struct gas_job *job, enum gas_kernel kernel)
{
    struct gas_kernels *kernels = job->solver->kernels;
    if (!gas_kernels_use(kernels, kernel, job->error))
        return false;
    gas_kernels_dispatch(kernels, cells_of_window(job->solver->gas));
    return true;
}

/* Ends a pass. */
static enum gas_failure done(struct gas_job *job, bool ok)
{
    return ok && kiln_device_check(job->solver->kernels->device, "gas", job->error) ? GAS_STEPPED
                                                                                    : GAS_STOPPED;
}

static void nothing(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)context;
    (void)begin;
    (void)end;
    (void)worker;
}

/* ---- passes ---------------------------------------------------------------------------------- */

static bool bind_cells(struct gas_job *job)
{
    struct gas_fields *fields = job->solver->fields;
    const GLuint params = kiln_buffer_gl(&fields->of[GAS_FIELD_PARAMS], KILN_READ, job->error);
    if (!params)
        return false;
    glBindBufferBase(GL_UNIFORM_BUFFER, GAS_BIND_PARAMS, params);
    return reads(job, GAS_BIND_BRICKS, GAS_FIELD_BRICKS) &&
           reads(job, GAS_BIND_FACES, GAS_FIELD_FACES) &&
           writes(job, GAS_BIND_CENTRES, GAS_FIELD_CENTRES) &&
           writes(job, GAS_BIND_NOW, GAS_FIELD_NOW) &&
           writes(job, GAS_BIND_TRACED, GAS_FIELD_TRACED) &&
           writes(job, GAS_BIND_CHANGES, GAS_FIELD_CHANGES) &&
           writes(job, GAS_BIND_EXPANDED, GAS_FIELD_EXPANDED) &&
           writes(job, GAS_BIND_FOUND, GAS_FIELD_FOUND);
}

static enum gas_failure trace(struct gas_job *job)
{
    struct gas_fields *fields = job->solver->fields;
    const bool extras = kiln_gas_groups(&job->solver->gas->shape) > 0;
    bool ok = kiln_threads_try(job->solver->threads, 1, 1, nothing, NULL, job->error) &&
              gas_fields_begin(fields, job) && bind_cells(job) &&
              (!extras || (writes(job, GAS_BIND_EXTRAS, GAS_FIELD_EXTRAS) &&
                           writes(job, GAS_BIND_NEXT, GAS_FIELD_NEXT)));
    ok = ok && run_all(job, GAS_KERNEL_CENTRES) &&
         run_list(job, GAS_KERNEL_TRACE, fields->active, GAS_BRICK_CELLS) &&
         (!extras || run_list(job, GAS_KERNEL_EXTRAS, fields->active, GAS_BRICK_CELLS));
    if (ok && fields->walled.count > 0)
        ok = reads(job, GAS_BIND_WALLS, GAS_FIELD_WALLS) &&
             run_list(job, extras ? GAS_KERNEL_WALLS_EXTRAS : GAS_KERNEL_WALLS, fields->walled,
                      GAS_BRICK_CELLS);
    return done(job, ok);
}

/* Finds what bricks have. to: number of the place of the first brick's. */
static bool find(struct gas_job *job, uint32_t to)
{
    const struct gas_solver *s = job->solver;
    if (!gas_kernels_use(s->kernels, GAS_KERNEL_FOUND, job->error))
        return false;
    glUniform1ui(GAS_AT_FOUND, to * GAS_BRICK);
    return run_list(job, GAS_KERNEL_FOUND, s->fields->active, GAS_BRICK);
}

static enum gas_failure react(struct gas_job *job)
{
    struct gas_fields *fields = job->solver->fields;
    const struct gas_pass *pass = job->pass;
    bool ok = writes(job, GAS_BIND_STIRS, GAS_FIELD_STIRS) &&
              (!pass->forces.points || reads(job, GAS_BIND_LATTICE, GAS_FIELD_LATTICE)) &&
              writes(job, GAS_BIND_NEXT, GAS_FIELD_AFTER);
    if (ok && pass->step->confinement > 0.0f)
        ok = run_list(job, GAS_KERNEL_SPIN, fields->stirred, GAS_SPINS);
    if (ok && pass->stir.strength > 0.0f)
        ok = run_list(job, GAS_KERNEL_NOISE, fields->stirred, GAS_NOISE_POINTS);
    ok = ok && run_list(job, GAS_KERNEL_REACT, fields->active, GAS_BRICK_CELLS) &&
         run_list(job, GAS_KERNEL_BLOW, fields->idle, GAS_BRICK_CELLS);
    if (ok) {
        kiln_buffer_swap_gl(&fields->of[GAS_FIELD_NOW], &fields->of[GAS_FIELD_AFTER]);
        gas_fields_are_newer(fields);
    }
    return done(job, ok && writes(job, GAS_BIND_NOW, GAS_FIELD_NOW) && find(job, 0));
}

/* Holds the bricks that a source reaches, and how far their cells lie in it. */
struct reached {
    struct gas_job *job;
    uint32_t source;
    uint32_t *bricks; /* numbers in the list of active bricks */
    float4 *cells;
    bool *any;
};

static void reach(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct reached *r = context;
    const struct gas_job *job = r->job;
    const struct gas_hooks *hooks = job->hooks;
    for (size_t i = begin; i < end; i++)
        r->any[i] =
            hooks->reach(hooks->context, job->pass, r->source,
                         job->solver->active.brick[r->bricks[i]], r->cells + i * GAS_BRICK_CELLS);
}

/* Sends what a source reaches, and lists its bricks. */
static bool send_reached(struct gas_job *job, const struct reached *r, uint32_t count,
                         struct gas_listed *list)
{
    struct gas_solver *s = job->solver;
    struct gas_fields *fields = s->fields;
    uint32_t *words = malloc((size_t)2 * count * sizeof *words);
    if (!words)
        return kiln_error_no_memory(job->error, "gas");
    for (uint32_t i = 0; i < count; i++) {
        const gas_brick_place at = s->active.brick[r->bricks[i]];
        if (!r->any[i])
            continue;
        s->sourced[r->bricks[i]] = true;
        uint32_t *entry = words + (size_t)2 * list->count++;
        entry[0] = (uint32_t)kiln_gas_brick_index(s->gas, at.x, at.y, at.z);
        entry[1] = i * GAS_BRICK_CELLS;
    }
    const bool ok =
        list->count == 0 ||
        (gas_fields_send(fields, GAS_FIELD_LISTED, words, (size_t)2 * list->count * sizeof *words,
                         job->error) &&
         gas_fields_send(fields, GAS_FIELD_SENT, r->cells,
                         (size_t)count * GAS_BRICK_CELLS * sizeof *r->cells, job->error) &&
         reads(job, GAS_BIND_BRICKS, GAS_FIELD_LISTED) &&
         reads(job, GAS_BIND_SENT, GAS_FIELD_SENT));
    free(words);
    return ok;
}

/* Adds a source to the cells that it reaches. */
static bool add_source(struct gas_job *job, uint32_t number, const struct gas_brought *b)
{
    struct gas_solver *s = job->solver;
    const bool colored = s->gas->shape.colored;
    const enum gas_kernel kernel = colored ? GAS_KERNEL_ADD_COLORED : GAS_KERNEL_ADD;
    uint32_t count = 0;
    struct reached r = {.job = job, .source = number};
    struct gas_listed list = {.count = 0};
    r.bricks = malloc(s->active.count * sizeof *r.bricks);
    for (uint32_t i = 0; r.bricks && i < s->active.count; i++)
        if (gas_region_has(&b->region, s->gas, s->active.brick[i]))
            r.bricks[count++] = i;
    r.cells = count > 0 ? malloc((size_t)count * GAS_BRICK_CELLS * sizeof *r.cells) : NULL;
    r.any = count > 0 ? malloc(count * sizeof *r.any) : NULL;
    bool ok = r.bricks && (count == 0 || (r.cells && r.any));
    if (!ok)
        kiln_error_no_memory(job->error, "gas");
    ok = ok && kiln_threads_try(s->threads, count, 1, reach, &r, job->error) &&
         send_reached(job, &r, count, &list) && gas_kernels_use(s->kernels, kernel, job->error);
    if (ok && list.count > 0) {
        const float brought[8] = {b->fuel,     b->temperature, b->smoke,    b->taken,
                                  b->color[0], b->color[1],    b->color[2], b->blows ? 1.0f : 0.0f};
        glUniform4fv(GAS_AT_SOURCE, 2, brought);
        ok = run_list(job, kernel, list, GAS_BRICK_CELLS);
    }
    free(r.bricks);
    free(r.cells);
    free(r.any);
    return ok;
}

static enum gas_failure add(struct gas_job *job)
{
    struct gas_solver *s = job->solver;
    const struct gas_hooks *hooks = job->hooks;
    struct gas_brought brought;
    bool ok = !s->gas->shape.colored || writes(job, GAS_BIND_NEXT, GAS_FIELD_NEXT);
    for (uint32_t i = 0; ok && hooks->brings && hooks->brings(hooks->context, i, &brought); i++)
        ok = add_source(job, i, &brought);
    ok = ok && reads(job, GAS_BIND_BRICKS, GAS_FIELD_BRICKS) && find(job, s->active.count);
    return done(job, ok);
}

/* Takes the gas away from the cells that solids take. */
static bool empty_cells(struct gas_job *job)
{
    struct gas_fields *fields = job->solver->fields;
    const struct gas_pass *pass = job->pass;
    const size_t count = pass->emptied_count;
    if (count == 0)
        return true;
    uint32_t *words = malloc(count * (2 + 16) * sizeof *words);
    if (!words)
        return kiln_error_no_memory(job->error, "gas");
    for (size_t i = 0; i < count; i++) {
        words[2 * i] = (uint32_t)pass->emptied[i].brick;
        words[2 * i + 1] = (uint32_t)(16 * i);
        memcpy(words + 2 * count + 16 * i, pass->emptied[i].cells, sizeof pass->emptied[i].cells);
    }
    const struct gas_listed list = {.count = (uint32_t)count};
    const bool ok =
        gas_fields_send(fields, GAS_FIELD_LISTED, words, 2 * count * sizeof *words, job->error) &&
        gas_fields_send(fields, GAS_FIELD_SENT, words + 2 * count, 16 * count * sizeof *words,
                        job->error) &&
        reads(job, GAS_BIND_BRICKS, GAS_FIELD_LISTED) &&
        reads(job, GAS_BIND_SENT, GAS_FIELD_SENT) &&
        run_list(job, GAS_KERNEL_EMPTY, list, GAS_BRICK_CELLS);
    free(words);
    return ok;
}

static enum gas_failure move_walls(struct gas_job *job)
{
    const struct gas_hooks *hooks = job->hooks;
    if (!hooks->move_walls)
        return GAS_STEPPED;
    if (!hooks->move_walls(hooks->context, job->pass, &job->solver->levels))
        return GAS_NO_MEMORY;
    return done(job, empty_cells(job) && gas_fields_send_walls(job->solver->fields, job) &&
                         reads(job, GAS_BIND_BRICKS, GAS_FIELD_BRICKS));
}

/* Sums up the columns of a brick as the host does, which is in the order of x. */
static double sum_of(const uint32_t *found, int word)
{
    double sum = 0.0;
    for (int x = 0; x < GAS_BRICK; x++) {
        float number;
        memcpy(&number, found + (ptrdiff_t)4 * x + word, sizeof number);
        sum += (double)number;
    }
    return sum;
}

/* Reads what the bricks found. */
static bool read_found(struct gas_job *job)
{
    struct gas_solver *s = job->solver;
    const uint32_t *found =
        kiln_buffer_host(&s->fields->of[GAS_FIELD_FOUND], KILN_READ, job->error);
    const size_t a_brick = (size_t)4 * GAS_BRICK;
    for (uint32_t i = 0; found && i < s->active.count; i++, found += a_brick) {
        const uint32_t *after = found + s->active.count * a_brick; /* after sources */
        uint32_t flags = 0;
        for (int x = 0; x < GAS_BRICK; x++)
            flags |= found[(ptrdiff_t)4 * x];
        s->found[i] = (struct gas_found){.has_gas = flags & GAS_FOUND_GAS,
                                         .is_wrong = flags & GAS_FOUND_WRONG,
                                         .moved = sum_of(found, 1),
                                         .left = sum_of(after, 2),
                                         .growth = sum_of(found, 3)};
    }
    return found != NULL;
}

static enum gas_failure push(struct gas_job *job)
{
    struct gas_fields *fields = job->solver->fields;
    const bool walled = job->pass->walls != NULL;
    bool ok = writes(job, GAS_BIND_FACES, GAS_FIELD_FACES) &&
              writes(job, GAS_BIND_CHANGES, GAS_FIELD_CHANGES) &&
              (!walled || reads(job, GAS_BIND_WALLS, GAS_FIELD_WALLS)) &&
              run_list(job, walled ? GAS_KERNEL_PUSH_WALLED : GAS_KERNEL_PUSH, fields->pushed,
                       GAS_BRICK_CELLS);
    if (ok && kiln_gas_groups(&job->solver->gas->shape) > 0)
        kiln_buffer_swap_gl(&fields->of[GAS_FIELD_EXTRAS], &fields->of[GAS_FIELD_NEXT]);
    return done(job, ok && read_found(job));
}

static enum gas_failure diverge(struct gas_job *job)
{
    const bool walled = job->pass->walls != NULL;
    return done(job, writes(job, GAS_BIND_F, GAS_FIELD_F) &&
                         (!walled || (reads(job, GAS_BIND_OPEN, GAS_FIELD_OPEN) &&
                                      reads(job, GAS_BIND_WALLED, GAS_FIELD_WALLED))) &&
                         run_all(job, walled ? GAS_KERNEL_DIVERGE_WALLED : GAS_KERNEL_DIVERGE));
}

static enum gas_failure solve(struct gas_job *job)
{
    return done(job, gas_solve_gl(job));
}

static enum gas_failure project(struct gas_job *job)
{
    struct gas_solver *s = job->solver;
    struct gas_fields *fields = s->fields;
    const bool walled = job->pass->walls != NULL;
    const uint32_t zero = 0;
    const bool ok = gas_fields_send(fields, GAS_FIELD_FASTEST, &zero, sizeof zero, job->error) &&
                    writes(job, GAS_BIND_FOUND, GAS_FIELD_FASTEST) &&
                    writes(job, GAS_BIND_P, GAS_FIELD_P) &&
                    run_all(job, walled ? GAS_KERNEL_PROJECT_WALLED : GAS_KERNEL_PROJECT);
    const float *fastest =
        ok ? kiln_buffer_host(&fields->of[GAS_FIELD_FASTEST], KILN_READ, job->error) : NULL;
    if (fastest)
        s->gas->fastest = *fastest;
    return fastest && !isfinite(*fastest) ? GAS_WRONG : done(job, fastest != NULL);
}

const struct gas_passes gas_passes_gl = {
    .init = init,
    .finish = finish,
    .init_window = init_window,
    .free_window = free_window,
    .clear_group = clear_group,
    .pass = {[GAS_TIMER_TRACE] = trace,
             [GAS_TIMER_REACT] = react,
             [GAS_TIMER_SOURCES] = add,
             [GAS_TIMER_WALLS] = move_walls,
             [GAS_TIMER_PUSH] = push,
             [GAS_TIMER_DIVERGE] = diverge,
             [GAS_TIMER_PRESSURE] = solve,
             [GAS_TIMER_PROJECT] = project},
};
