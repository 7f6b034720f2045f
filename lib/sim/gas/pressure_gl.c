/* This file runs the V-cycles of the pressure (multigrid.c) in GL. Lengths and means, which few
 * scenes ask for, are sums of doubles in the order of the host, which reads the numbers back. */
#include <string.h>

#include "sim/gas/passes_gl.h"

/* Holds what V-cycles run with. After a part that fails, no more run. */
struct relaxing {
    struct gas_job *job;
    bool walled, ok;
    uint32_t closed;
};

/* Sends where a level lies in the buffers: struct level of pressure.glsl. */
static void set_level(GLint at, const struct gas_levels *levels, const struct gas_level *level)
{
    uint32_t floats = 0, tables = 0, rows = 0;
    for (const struct gas_level *l = levels->level; l < level; l++) {
        floats += (uint32_t)gas_level_floats(l);
        tables += 18 * (uint32_t)l->row;
        rows += (uint32_t)l->cells.y * (uint32_t)l->cells.z;
    }
    const struct kiln_gas_place n = level->cells;
    const uint32_t row = (uint32_t)level->row;
    const GLuint words[16] = {(uint32_t)n.x,
                              (uint32_t)n.y,
                              (uint32_t)n.z,
                              floats,
                              row,
                              (uint32_t)level->plane,
                              (uint32_t)level->odd,
                              (uint32_t)gas_level_first(level),
                              tables,
                              9 * row,
                              0,
                              0,
                              3 * floats,
                              (uint32_t)gas_level_floats(level),
                              rows,
                              0};
    glUniform4uiv(at, 4, words);
}

static uint32_t cells_of(struct kiln_gas_place n)
{
    return (uint32_t)n.x * (uint32_t)n.y * (uint32_t)n.z;
}

static bool use(struct relaxing *r, enum gas_kernel kernel)
{
    r->ok = r->ok && gas_kernels_use(r->job->solver->kernels, kernel, r->job->error);
    return r->ok;
}

/* color: 2: colour 0, where p is zero everywhere. */
static void relax(struct relaxing *r, const struct gas_level *level, uint32_t color)
{
    const struct gas_levels *levels = &r->job->solver->levels;
    if (!use(r, r->walled ? GAS_KERNEL_RELAX_WALLED : GAS_KERNEL_RELAX))
        return;
    const struct kiln_gas_place n = {(level->cells.x + 1) / 2, level->cells.y, level->cells.z};
    set_level(GAS_AT_LEVEL, levels, level);
    glUniform1ui(GAS_AT_COLOR, color);
    gas_kernels_dispatch(r->job->solver->kernels, cells_of(n));
}

/* Solves the coarsest level: by one work group, unless the level is large. */
static void solve_coarsest(struct relaxing *r, const struct gas_level *level, uint32_t sweeps)
{
    if (cells_of(level->cells) > GAS_COARSEST_CELLS) {
        relax(r, level, 2);
        for (uint32_t i = 0; i < 2 * sweeps; i++)
            relax(r, level, i & 1 ? 0 : 1);
        return;
    }
    if (!use(r, r->walled ? GAS_KERNEL_COARSEST_WALLED : GAS_KERNEL_COARSEST))
        return;
    set_level(GAS_AT_LEVEL, &r->job->solver->levels, level);
    glUniform1ui(GAS_AT_SWEEPS, sweeps);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

static void restrict_to(struct relaxing *r, const struct gas_level *fine,
                        const struct gas_level *coarse)
{
    const struct gas_levels *levels = &r->job->solver->levels;
    if (!use(r, r->walled ? GAS_KERNEL_RESTRICT_WALLED : GAS_KERNEL_RESTRICT))
        return;
    set_level(GAS_AT_LEVEL, levels, fine);
    set_level(GAS_AT_OTHER, levels, coarse);
    gas_kernels_dispatch(r->job->solver->kernels, cells_of(coarse->cells));
}

static void prolong(struct relaxing *r, const struct gas_level *fine,
                    const struct gas_level *coarse, uint32_t color)
{
    const struct gas_levels *levels = &r->job->solver->levels;
    const struct kiln_gas_place n = {coarse->cells.x, fine->cells.y, fine->cells.z};
    if (!use(r, GAS_KERNEL_PROLONG))
        return;
    set_level(GAS_AT_LEVEL, levels, fine);
    set_level(GAS_AT_OTHER, levels, coarse);
    glUniform1ui(GAS_AT_COLOR, color | r->closed << 1);
    gas_kernels_dispatch(r->job->solver->kernels, cells_of(n));
}

static void run(void *context, const struct gas_relaxation *what)
{
    struct relaxing *r = context;
    switch (what->kind) {
    case GAS_RELAX:
        relax(r, what->level, (uint32_t)what->color);
        break;
    case GAS_BEGIN:
        relax(r, what->level, 2);
        break;
    case GAS_RESTRICT:
        restrict_to(r, what->level, what->coarse);
        break;
    case GAS_PROLONG:
        prolong(r, what->level, what->coarse, (uint32_t)what->color);
        break;
    case GAS_COARSEST:
        solve_coarsest(r, what->level, (uint32_t)what->sweeps);
        break;
    }
}

static bool bind(struct gas_job *job)
{
    struct gas_fields *fields = job->solver->fields;
    const bool walled = job->pass->walls != NULL;
    return gas_fields_bind(fields, GAS_BIND_P, GAS_FIELD_P, true, job->error) &&
           gas_fields_bind(fields, GAS_BIND_F, GAS_FIELD_F, true, job->error) &&
           gas_fields_bind(fields, GAS_BIND_TABLES, GAS_FIELD_TABLES, false, job->error) &&
           (!walled ||
            (gas_fields_bind(fields, GAS_BIND_OPEN, GAS_FIELD_OPEN, false, job->error) &&
             gas_fields_bind(fields, GAS_BIND_WALLED, GAS_FIELD_WALLED, false, job->error)));
}

static bool cycle(struct gas_job *job)
{
    struct relaxing r = {.job = job,
                         .walled = job->pass->walls != NULL,
                         .ok = bind(job),
                         .closed = gas_closed_bits(job->pass)};
    if (r.ok)
        gas_levels_cycle(&job->solver->levels, &(struct gas_relaxer){&r, run}, job->cycles);
    return r.ok;
}

/* Returns the finest level with other numbers in place of f and p. */
static struct gas_level with(const struct gas_levels *levels, float *f, float *p)
{
    struct gas_level level = levels->level[0];
    const size_t first = gas_level_first(&level);
    level.f = f + first;
    level.p = p ? p + first : NULL;
    return level;
}

static bool center(struct gas_job *job)
{
    struct gas_fields *fields = job->solver->fields;
    float *f = kiln_buffer_host(&fields->of[GAS_FIELD_F], KILN_READ_WRITE, job->error);
    float *p = f ? kiln_buffer_host(&fields->of[GAS_FIELD_P], KILN_READ_WRITE, job->error) : NULL;
    if (!p)
        return false;
    const struct gas_level level = with(&job->solver->levels, f, p);
    gas_level_center(&level);
    return true;
}

static bool length(struct gas_job *job, bool residual, double *sum)
{
    struct gas_solver *s = job->solver;
    struct gas_fields *fields = s->fields;
    const struct gas_level *finest = &s->levels.level[0];
    const enum gas_field field = residual ? GAS_FIELD_RESIDUALS : GAS_FIELD_F;
    if (residual) {
        struct relaxing r = {.job = job, .ok = bind(job)};
        gas_fields_reserve(fields, field, gas_level_floats(finest) * sizeof(float));
        r.ok = r.ok && gas_fields_bind(fields, GAS_BIND_FOUND, field, true, job->error);
        if (!use(&r, job->pass->walls ? GAS_KERNEL_RESIDUAL_WALLED : GAS_KERNEL_RESIDUAL))
            return false;
        set_level(GAS_AT_LEVEL, &s->levels, finest);
        gas_kernels_dispatch(s->kernels, cells_of(finest->cells));
    }
    float *numbers = kiln_buffer_host(&fields->of[field], KILN_READ, job->error);
    if (!numbers)
        return false;
    const struct gas_level level = with(&s->levels, numbers, NULL);
    *sum = gas_level_length(&level, s->multigrid, false);
    return true;
}

bool gas_solve_gl(struct gas_job *job)
{
    static const struct gas_pressure in_gl = {.center = center, .cycle = cycle, .length = length};
    return gas_solver_find_pressure(job, &in_gl);
}
