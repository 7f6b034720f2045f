/* This file computes the particles at an instant within a step, on the host or in GL
 * (shaders/draw/moment/between.comp). The result is a pool, so that all stages of drawing see the
 * particles of the instant as they see a state. */
#include "draw/moment/between.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draw/moment/moment_gl.h"
#include "gpu/program.h"
#include "scene/pool_layout.h"
#include "shared/between.h"

enum { GROUP_SIZE = 64, SLOTS_AT_A_TIME = 4096 };

struct kiln_between {
    struct kiln_device *device;
    const struct kiln_moment *moment;
    struct kiln_threads *threads;
    GLuint program, spins_program; /* 0: the host computes; spins_program: for systems with spins */
    struct kiln_pool pool;         /* the result; its canvases and its gas are borrowed */
};

static bool make_programs(struct kiln_between *between, struct kiln_error *error)
{
    struct kiln_program_params params = {.compute = "draw/moment/between.comp"};
    between->program = kiln_program_create(between->device, &params, error);
    params.defines = "#define SPINS 1\n";
    if (between->program && kiln_scene_spins(between->moment->scene))
        between->spins_program = kiln_program_create(between->device, &params, error);
    return between->program &&
           (between->spins_program || !kiln_scene_spins(between->moment->scene));
}

struct kiln_between *kiln_between_create(struct kiln_device *device,
                                         const struct kiln_moment *moment, bool in_gl,
                                         struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_between *between = calloc(1, sizeof *between);
    if (!between) {
        kiln_error_no_memory(error, "particles within a step");
        return NULL;
    }
    between->device = device;
    between->moment = moment;
    between->threads = threads;
    if (in_gl && !make_programs(between, error))
        kiln_between_destroy(&between);
    return between;
}

void kiln_between_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    struct kiln_pool_layout layout = kiln_scene_pool_layout(scene);
    layout.canvas_count = 0;
    kiln_pool_footprint(&layout, footprint);
}

void kiln_between_destroy(struct kiln_between **between)
{
    struct kiln_between *b = *between;
    if (!b)
        return;
    if (b->program)
        glDeleteProgram(b->program);
    if (b->spins_program)
        glDeleteProgram(b->spins_program);
    b->pool.canvas_count = 0;
    b->pool.gas_count = 0;
    kiln_pool_finish(&b->pool);
    free(b);
    *between = NULL;
}

/* Makes the result's buffers as large as those of a state, and takes over which slots are used. */
static void prepare(struct kiln_between *between, const struct kiln_pool *after)
{
    struct kiln_pool *pool = &between->pool;
    if (!pool->records.label) /* not made yet; a scene without systems has buffers of 0 bytes */
        kiln_buffer_init(&pool->records, between->device, after->records.size,
                         "particles within a step");
    if (pool->spins.size != after->spins.size)
        kiln_buffer_init(&pool->spins, between->device, after->spins.size, "spins within a step");
    const struct kiln_buffer records = pool->records, spins = pool->spins;
    *pool = *after;
    pool->records = records;
    pool->spins = spins;
}

/* ---- on the host ----------------------------------------------------------------------------- */

struct host_job {
    struct kiln_derived_params derived;
    const float4 *keys;
    struct kiln_instant instant;
    const struct kiln_particle *before, *after;
    struct kiln_particle *between;
    const struct kiln_spin *spins_before, *spins_after;
    struct kiln_spin *spins_between; /* NULL: the system has no spins */
};

static void find_particles(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct host_job *job = context;
    const float back = job->instant.back;
    for (size_t i = begin; i < end; i++)
        job->between[i] = particle_between(job->keys, job->derived, job->before[i], job->after[i],
                                           job->instant.step, back);
    for (size_t i = begin; i < end && job->spins_between; i++)
        job->spins_between[i] = spin_between(job->after[i], job->spins_before[i],
                                             job->spins_after[i], job->derived.dt_s, back);
}

/* Fills the members that are the same for all systems, for slot 0 of the pool. */
static bool open_buffers(struct kiln_between *between, struct kiln_pool *before,
                         struct kiln_pool *after, struct host_job *job, struct kiln_error *error)
{
    struct kiln_pool *pool = &between->pool;
    job->before = kiln_buffer_host(&before->records, KILN_READ, error);
    job->after = job->before ? kiln_buffer_host(&after->records, KILN_READ, error) : NULL;
    job->between = job->after ? kiln_buffer_host(&pool->records, KILN_READ_WRITE, error) : NULL;
    if (!job->between || pool->spins.size == 0)
        return job->between;
    job->spins_before = kiln_buffer_host(&before->spins, KILN_READ, error);
    job->spins_after = job->spins_before ? kiln_buffer_host(&after->spins, KILN_READ, error) : NULL;
    job->spins_between =
        job->spins_after ? kiln_buffer_host(&pool->spins, KILN_READ_WRITE, error) : NULL;
    return job->spins_between;
}

static bool run_on_host(struct kiln_between *between, struct kiln_pool *before,
                        struct kiln_pool *after, struct kiln_instant instant,
                        struct kiln_error *error)
{
    const struct kiln_scene *scene = between->moment->scene;
    struct host_job all = {.keys = scene->keys, .instant = instant};
    if (!open_buffers(between, before, after, &all, error))
        return false;
    bool ok = true;
    for (uint32_t i = 0; ok && i < after->system_count; i++) {
        const struct kiln_pool_system *system = &after->systems[i];
        struct host_job job = all;
        job.derived = kiln_scene_derived(scene, i);
        job.before += system->base;
        job.after += system->base;
        job.between += system->base;
        job.spins_between = NULL;
        if (system->spins) {
            job.spins_before += system->first_spin;
            job.spins_after += system->first_spin;
            job.spins_between = all.spins_between + system->first_spin;
        }
        ok = kiln_threads_try(between->threads, kiln_pool_used(system), SLOTS_AT_A_TIME,
                              find_particles, &job, error);
    }
    return ok;
}

/* ---- in GL ----------------------------------------------------------------------------------- */

static bool bind_three(GLuint binding, struct kiln_buffer *before, struct kiln_buffer *after,
                       struct kiln_buffer *between, struct kiln_error *error)
{
    const GLuint first = kiln_buffer_gl(before, KILN_READ, error);
    const GLuint second = first ? kiln_buffer_gl(after, KILN_READ, error) : 0;
    const GLuint result = second ? kiln_buffer_gl(between, KILN_READ_WRITE, error) : 0;
    if (!result)
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, first);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding + 1, second);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding + 2, result);
    return true;
}

static bool run_in_gl(struct kiln_between *between, struct kiln_pool *before,
                      struct kiln_pool *after, struct kiln_instant instant,
                      struct kiln_error *error)
{
    struct kiln_pool *pool = &between->pool;
    if (!kiln_moment_bind_looks(between->moment, error) ||
        !bind_three(BETWEEN_BIND_BEFORE, &before->records, &after->records, &pool->records,
                    error) ||
        (pool->spins.size > 0 &&
         !bind_three(BETWEEN_BIND_SPIN_BEFORE, &before->spins, &after->spins, &pool->spins, error)))
        return false;
    for (uint32_t i = 0; i < after->system_count; i++) {
        const struct kiln_pool_system *system = &after->systems[i];
        glUseProgram(system->spins ? between->spins_program : between->program);
        glUniform1ui(BETWEEN_AT_SYSTEM, i);
        glUniform1ui(BETWEEN_AT_BASE, system->base);
        glUniform1ui(BETWEEN_AT_USED, kiln_pool_used(system));
        glUniform1ui(BETWEEN_AT_STEP, instant.step);
        glUniform1f(BETWEEN_AT_BACK, instant.back);
        if (system->spins)
            glUniform1ui(BETWEEN_AT_FIRST_SPIN, system->first_spin);
        kiln_device_dispatch(between->device, kiln_pool_used(system), GROUP_SIZE);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return kiln_device_check(between->device, "particles within a step", error);
}

struct kiln_pool *kiln_between_run(struct kiln_between *between, struct kiln_pool *before,
                                   struct kiln_pool *after, struct kiln_instant instant,
                                   struct kiln_error *error)
{
    prepare(between, after);
    const bool ok = between->program ? run_in_gl(between, before, after, instant, error)
                                     : run_on_host(between, before, after, instant, error);
    return ok ? &between->pool : NULL;
}
