/* This file gathers pushes in compute shaders: it runs the kernels of
 * shaders/sim/crowd/interact_*.comp that the scene's interactions need, one after the other. */
#include <stdio.h>

#include "base/error.h"
#include "gpu/program.h"
#include "shared/interact_speeds.h"
#include "shared/limits.h"
#include "sim/crowd/contact_row.h"

/* Bits of used_for: the kinds of interaction that a kernel serves, and what several of them do. */
enum { COLLIDE = 1, LOOK_AHEAD = 2, GRAVITY = 4, FLOCK = 8, CELLS = 16 };

static const struct {
    struct kiln_interact_file source;
    int used_for;
} KERNELS[KILN_INTERACT_KERNELS] = {
    [KILN_INTERACT_SPEEDS] = {{"sim/crowd/interact_speeds.comp", "", false}, LOOK_AHEAD},
    [KILN_INTERACT_SCAN] = {{"sim/crowd/interact_scan.comp", "", false}, CELLS},
    [KILN_INTERACT_PLACE] = {{"sim/crowd/interact_place.comp", "", false}, CELLS},
    [KILN_INTERACT_ANSWER] = {{"sim/crowd/interact_answer.comp", "", false}, COLLIDE},
    [KILN_INTERACT_PUSH] = {{"sim/crowd/interact_push.comp", "", false}, COLLIDE},
    [KILN_INTERACT_SOURCES] = {{"sim/crowd/interact_sources.comp", "", false}, GRAVITY},
    [KILN_INTERACT_GRAVITY_TILES] = {{"sim/crowd/interact_gravity.comp", "", false}, GRAVITY},
    [KILN_INTERACT_COUNT_FLOCK] = {{"sim/crowd/interact_count.comp", "#define FLOCK 1\n", false},
                                   FLOCK},
    [KILN_INTERACT_FLOCK_MEANS] = {{"sim/crowd/interact_flock_means.comp", "", false}, FLOCK},
    [KILN_INTERACT_FLOCK_STEER] = {{"sim/crowd/interact_flock.comp", "", false}, FLOCK},
};

static int contact_uses(const struct kiln_contact_row *row)
{
    return COLLIDE | (row->looks_ahead ? LOOK_AHEAD : 0) | (row->uses_cells ? CELLS : 0);
}

static int uses(const struct kiln_scene *scene)
{
    int all = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_interaction *collide =
            kiln_scene_interaction(scene, i, KILN_INTERACT_COLLIDE);
        if (collide)
            all |= contact_uses(kiln_contact_row(collide->mode));
        if (kiln_scene_interaction(scene, i, KILN_INTERACT_GRAVITY))
            all |= GRAVITY;
        if (kiln_scene_interaction(scene, i, KILN_INTERACT_FLOCK))
            all |= FLOCK | CELLS;
    }
    return all;
}

/* The most bodies that one body may look at on software GL, which silently ends loops after
 * KILN_SOFTWARE_ITERATIONS. The difference is left for the loops over rows of cells. */
enum { MOST_AROUND = KILN_SOFTWARE_ITERATIONS - 535 };

static GLuint create_program(const struct kiln_interact *interact,
                             const struct kiln_interact_file *source, struct kiln_error *error)
{
    char defines[160], counted[48] = "";
    if (source->counts_around && interact->device->info.software)
        snprintf(counted, sizeof counted, "#define MOST_AROUND %uu\n", (unsigned)MOST_AROUND);
    snprintf(defines, sizeof defines, "#define SIM_GROUP_SIZE %u\n%s%s%s%s", interact->group_size,
             source->defines, counted, interact->spins ? "#define SPINS 1\n" : "",
             kiln_scene_stores_keys(interact->scene) ? "#define KEYS_STORED 1\n" : "");
    const struct kiln_program_params params = {.compute = source->file, .defines = defines};
    return kiln_program_create(interact->device, &params, error);
}

/* Creates the programs of the way in which a system's collisions find partners. */
static bool create_contact_programs(struct kiln_interact *interact, enum kiln_contact_mode mode,
                                    struct kiln_error *error)
{
    const struct kiln_interact_file *files = kiln_contact_row(mode)->files;
    GLuint *programs = interact->contact_programs[mode];
    for (int i = 0; i < KILN_CONTACT_PROGRAMS && files[i].file && !programs[i]; i++) {
        programs[i] = create_program(interact, &files[i], error);
        if (!programs[i])
            return false;
    }
    return true;
}

bool kiln_interact_gl_init(struct kiln_interact *interact, struct kiln_error *error)
{
    struct kiln_device *device = interact->device;
    const int used = uses(interact->scene);
    GLint bindings = 0, blocks = 0;
    glGetIntegerv(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, &bindings);
    glGetIntegerv(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, &blocks);
    bindings = blocks < bindings ? blocks : bindings;
    interact->spins = kiln_scene_spins(interact->scene);
    if (interact->spins && bindings <= INTERACT_BIND_SPINS)
        return kiln_error_set(error, KILN_NO_DEVICE,
                              "%s: there are %d places for storage blocks, and balls that spin "
                              "need %d; use simulate=cpu",
                              device->info.name, bindings, INTERACT_BIND_SPINS + 1);
    if (kiln_scene_stores_keys(interact->scene) && bindings <= INTERACT_BIND_KEYS)
        return kiln_error_set(error, KILN_NO_DEVICE,
                              "%s: there are %d places for storage blocks, and interactions in a "
                              "scene of more than %d keys need %d; use simulate=cpu",
                              device->info.name, bindings, KILN_BLOCK_KEYS, INTERACT_BIND_KEYS + 1);
    interact->group_size = device->work_group_size ? device->work_group_size : SIM_GROUP_SIZE;
    for (int i = 0; i < KILN_INTERACT_KERNELS; i++) {
        if ((used & KERNELS[i].used_for) == 0)
            continue;
        interact->programs[i] = create_program(interact, &KERNELS[i].source, error);
        if (!interact->programs[i])
            return false;
    }
    for (uint32_t i = 0; i < interact->scene->system_count; i++) {
        const struct kiln_interaction *collide =
            kiln_scene_interaction(interact->scene, i, KILN_INTERACT_COLLIDE);
        if (collide && !create_contact_programs(interact, collide->mode, error))
            return false;
    }
    return true;
}

void kiln_interact_run(const struct kiln_interact *interact, GLuint program, uint32_t count)
{
    glUseProgram(program);
    kiln_device_dispatch(interact->device, count, interact->group_size);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

static void run(const struct kiln_interact *interact, enum kiln_interact_kernel kernel,
                uint32_t count)
{
    kiln_interact_run(interact, interact->programs[kernel], count);
}

bool kiln_interact_bind(GLuint at, struct kiln_buffer *buffer, enum kiln_access access,
                        struct kiln_error *error)
{
    const GLuint gl = kiln_buffer_gl(buffer, access, error);
    if (gl)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, at, gl);
    return gl != 0;
}

static bool set_params(struct kiln_interact *interact, const struct kiln_interact_params *params,
                       struct kiln_error *error)
{
    const GLuint block = kiln_buffer_upload(&interact->block, params, error);
    if (block)
        glBindBufferBase(GL_UNIFORM_BUFFER, INTERACT_BIND_PARAMS, block);
    return block != 0;
}

static bool bind_all(struct kiln_interact *interact, const struct kiln_interact_work *work,
                     struct kiln_pool *pool, struct kiln_buffer *keys, struct kiln_error *error)
{
    const GLuint values = kiln_buffer_gl(keys, KILN_READ, error);
    if (!values || !set_params(interact, &work->params, error))
        return false;
    if (kiln_scene_stores_keys(interact->scene))
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, INTERACT_BIND_KEYS, values);
    else
        glBindBufferBase(GL_UNIFORM_BUFFER, SIM_BIND_KEYS, values);
    const enum kiln_access change = KILN_READ_WRITE;
    const bool sorts = work->collides || work->flocks;
    if (interact->spins && !kiln_interact_bind(INTERACT_BIND_SPINS, &pool->spins, change, error))
        return false;
    return kiln_interact_bind(SIM_BIND_RECORDS, &pool->records, KILN_READ, error) &&
           kiln_interact_bind(SIM_BIND_PUSHES, &interact->pushes, change, error) &&
           (!sorts ||
            (kiln_interact_bind(INTERACT_BIND_CELLS, &interact->cells, change, error) &&
             kiln_interact_bind(INTERACT_BIND_PARTNERS, &interact->partners, change, error) &&
             kiln_interact_bind(INTERACT_BIND_BODIES, &interact->bodies, change, error) &&
             kiln_interact_bind(INTERACT_BIND_SECOND, &interact->second, change, error))) &&
           ((!work->pulls && !work->flocks) ||
            kiln_interact_bind(INTERACT_BIND_ENTRIES, &interact->entries, change, error));
}

void kiln_interact_empty_cells(const struct kiln_interact *interact, uint32_t cells)
{
    const GLuint zero = 0;
    glBindBuffer(GL_COPY_WRITE_BUFFER, interact->cells.gl);
    glClearBufferSubData(GL_COPY_WRITE_BUFFER, GL_R32UI, 0,
                         (GLsizeiptr)cells * (GLsizeiptr)sizeof zero, GL_RED_INTEGER,
                         GL_UNSIGNED_INT, &zero);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

bool kiln_interact_gl_speeds(struct kiln_interact *interact, const struct kiln_interact_work *work,
                             struct kiln_pool *pool, struct kiln_buffer *keys, uint32_t *bounds,
                             struct kiln_error *error)
{
    if (!bind_all(interact, work, pool, keys, error))
        return false;
    kiln_interact_empty_cells(interact, SPEEDS_BOUNDS);
    run(interact, KILN_INTERACT_SPEEDS, work->params.used);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, interact->cells.gl);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, SPEEDS_BOUNDS * (GLsizeiptr)sizeof *bounds, bounds);
    return kiln_device_check(interact->device, "interact", error);
}

void kiln_interact_gl_into_cells(const struct kiln_interact *interact,
                                 const struct kiln_interact_params *params, GLuint count)
{
    kiln_interact_empty_cells(interact, params->cell_mask + 2);
    kiln_interact_run(interact, count, params->used);
    glUseProgram(interact->programs[KILN_INTERACT_SCAN]);
    glUniform1ui(INTERACT_AT_CELL_COUNT, params->cell_mask + 1);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    run(interact, KILN_INTERACT_PLACE, params->used);
}

/* Returns whether each body looked at all others near it. On software GL a loop may have ended
 * early. */
static bool saw_all(const struct kiln_interact *interact, const struct kiln_interact_work *work,
                    struct kiln_error *error)
{
    if (!interact->device->info.software || work->mode != KILN_CONTACT_EXACT)
        return true;
    GLuint around = 0;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, interact->cells.gl);
    glGetBufferSubData(GL_COPY_READ_BUFFER,
                       (GLintptr)(work->params.cell_mask + 1) * (GLintptr)sizeof around,
                       (GLsizeiptr)sizeof around, &around);
    if (around <= MOST_AROUND)
        return true;
    return kiln_error_set(
        error, KILN_DEVICE_FAILED,
        "systems.%s.interact: a particle has %u others near enough to collide with; software GL "
        "tests at most %u: use --technique simulate=cpu, a smaller `radius` or a lower `fastest`",
        work->system, around, (unsigned)MOST_AROUND);
}

static bool collide(struct kiln_interact *interact, const struct kiln_interact_work *work,
                    struct kiln_error *error)
{
    const struct kiln_interact_params *params = &work->params;
    GLuint find = 0;
    if (!kiln_contact_row(work->mode)->sort_gl(interact, params, &find, error))
        return false;
    GLuint bodies = interact->bodies.gl, second = interact->second.gl;
    for (uint32_t round = 0; round < work->rounds; round++) {
        glUseProgram(find);
        glUniform1ui(INTERACT_AT_IS_LATER_ROUND, round > 0);
        kiln_interact_run(interact, find, params->used);
        run(interact, KILN_INTERACT_ANSWER, params->used);
        const GLuint before = bodies;
        bodies = second;
        second = before;
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, INTERACT_BIND_BODIES, bodies);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, INTERACT_BIND_SECOND, second);
    }
    if (!saw_all(interact, work, error))
        return false;
    run(interact, KILN_INTERACT_PUSH, params->used);
    return true;
}

/* The number of sources in a dispatch. It is so low that llvmpipe does not end a loop early,
 * whatever the size of work groups. */
enum { SOURCES_AT_A_TIME = 1 << 14 };

static bool pull(struct kiln_interact *interact, const struct kiln_interact_work *work,
                 struct kiln_error *error)
{
    const uint32_t all = work->sources.used;
    if (!set_params(interact, &work->sources, error))
        return false;
    run(interact, KILN_INTERACT_SOURCES, all);
    if (!set_params(interact, &work->params, error))
        return false;
    glUseProgram(interact->programs[KILN_INTERACT_GRAVITY_TILES]);
    glUniform1ui(INTERACT_AT_ALL_SOURCES, all);
    glUniform1ui(INTERACT_AT_SUMS, interact->half);
    uint32_t first = 0;
    do {
        const uint32_t left = all - first;
        const uint32_t end = first + (left < SOURCES_AT_A_TIME ? left : SOURCES_AT_A_TIME);
        glUniform1ui(INTERACT_AT_FIRST_SOURCE, first);
        glUniform1ui(INTERACT_AT_END_SOURCE, end);
        run(interact, KILN_INTERACT_GRAVITY_TILES, work->params.used);
        first = end;
    } while (first < all);
    return true;
}

static void flock(const struct kiln_interact *interact, const struct kiln_interact_params *params)
{
    kiln_interact_gl_into_cells(interact, params, interact->programs[KILN_INTERACT_COUNT_FLOCK]);
    run(interact, KILN_INTERACT_FLOCK_MEANS, 1);
    run(interact, KILN_INTERACT_FLOCK_STEER, params->used);
}

bool kiln_interact_gl(struct kiln_interact *interact, const struct kiln_interact_work *work,
                      struct kiln_pool *pool, struct kiln_buffer *keys, struct kiln_error *error)
{
    if (!work->collides && !work->pulls && !work->flocks)
        return true;
    if (!bind_all(interact, work, pool, keys, error))
        return false;
    if ((work->collides && !collide(interact, work, error)) ||
        (work->pulls && !pull(interact, work, error)))
        return false;
    if (work->flocks)
        flock(interact, &work->params);
    return kiln_device_check(interact->device, "interact", error);
}
