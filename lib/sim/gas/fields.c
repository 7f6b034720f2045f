/* This file brings the gas of a domain to GL and back, and what a substep needs beside it. Arrays
 * over cells have room for all bricks of the window, so that a place in them follows from the place
 * of a cell; what idle bricks carry stays zero. */
#include "sim/gas/fields.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"

#define WALL_BYTES ((size_t)GAS_WALL_WORDS * sizeof(uint32_t))

enum { CELL_BYTES = GAS_CARRIED * sizeof(float), BRICK_BYTES = GAS_BRICK_CELLS * CELL_BYTES };

static size_t brick_count(const struct kiln_gas *gas)
{
    return (size_t)gas->bricks.x * (size_t)gas->bricks.y * (size_t)gas->bricks.z;
}

/* Returns the floats of an array of faces. */
static size_t array_floats(const struct kiln_gas *gas)
{
    return (size_t)(gas->faces[1] - gas->faces[0]);
}

void gas_fields_init(struct gas_fields *fields, struct gas_kernels *kernels, struct kiln_gas *gas)
{
    static const char *const labels[GAS_FIELD_COUNT] = {
#define GAS_FIELD_LABEL(name, label) [GAS_FIELD_##name] = label,
        GAS_FIELDS(GAS_FIELD_LABEL)
#undef GAS_FIELD_LABEL
    };
    *fields = (struct gas_fields){.kernels = kernels, .gas = gas};
    for (int i = 0; i < GAS_FIELD_COUNT; i++)
        kiln_buffer_init(&fields->of[i], kernels->device, 0, labels[i]);
}

void gas_fields_free_window(struct gas_fields *fields)
{
    for (int i = 0; i < GAS_FIELD_COUNT; i++) {
        const char *label = fields->of[i].label;
        kiln_buffer_finish(&fields->of[i]);
        kiln_buffer_init(&fields->of[i], fields->kernels->device, 0, label);
    }
    free(fields->awake);
    free(fields->words);
    fields->awake = NULL;
    fields->words = NULL;
    fields->is_filled = false;
    fields->walls_made = 0;
}

void gas_fields_finish(struct gas_fields *fields)
{
    gas_fields_free_window(fields);
    if (fields->gas->away.context == fields)
        fields->gas->away = (struct kiln_gas_away){.context = NULL};
}

void gas_fields_reserve(struct gas_fields *fields, enum gas_field field, size_t size)
{
    struct kiln_buffer *buffer = &fields->of[field];
    if (buffer->size < size)
        kiln_buffer_reserve(buffer, size > 2 * buffer->size ? size : 2 * buffer->size);
}

bool gas_fields_send(struct gas_fields *fields, enum gas_field field, const void *bytes,
                     size_t size, struct kiln_error *error)
{
    gas_fields_reserve(fields, field, size);
    struct kiln_buffer *buffer = &fields->of[field];
    void *host = kiln_buffer_host(buffer, KILN_OVERWRITE, error);
    if (!host)
        return false;
    memcpy(host, bytes, size);
    kiln_buffer_set_content(buffer, size);
    return kiln_buffer_gl(buffer, KILN_READ, error) != 0;
}

bool gas_fields_bind(struct gas_fields *fields, GLuint at, enum gas_field field, bool written,
                     struct kiln_error *error)
{
    return gas_kernels_bind(at, &fields->of[field], written ? KILN_READ_WRITE : KILN_READ, error);
}

/* ---- the host and GL ------------------------------------------------------------------------- */

/* Copies what active bricks carry between a buffer and their chunks. to_gl: from the chunks. */
static void copy_bricks(const struct kiln_gas *gas, char *buffer, bool to_gl, bool extras)
{
    const size_t bytes = extras ? kiln_gas_groups(&gas->shape) * (size_t)BRICK_BYTES : BRICK_BYTES;
    for (size_t i = 0; i < brick_count(gas); i++) {
        const struct kiln_gas_brick *brick = &gas->brick[i];
        float *own = extras ? brick->extras : brick->now;
        char *part = buffer + i * bytes;
        if (to_gl && own)
            memcpy(part, own, bytes);
        else if (to_gl)
            memset(part, 0, bytes);
        else if (own)
            memcpy(own, part, bytes);
    }
}

static bool fetch(void *context, struct kiln_error *error)
{
    struct gas_fields *fields = context;
    const struct kiln_gas *gas = fields->gas;
    const size_t array = array_floats(gas);
    const float *faces = kiln_buffer_host(&fields->of[GAS_FIELD_FACES], KILN_READ, error);
    const float *p = kiln_buffer_host(&fields->of[GAS_FIELD_P], KILN_READ, error);
    char *now = kiln_buffer_host(&fields->of[GAS_FIELD_NOW], KILN_READ, error);
    if (!faces || !p || !now)
        return false;
    memcpy(gas->arrays, faces, 3 * array * sizeof *faces);
    memcpy(gas->arrays + 3 * array, p, array * sizeof *p);
    copy_bricks(gas, now, false, false);
    if (kiln_gas_groups(&gas->shape) == 0)
        return true;
    char *extras = kiln_buffer_host(&fields->of[GAS_FIELD_EXTRAS], KILN_READ, error);
    if (extras)
        copy_bricks(gas, extras, false, true);
    return extras != NULL;
}

void gas_fields_are_newer(struct gas_fields *fields)
{
    fields->gas->away = (struct kiln_gas_away){.is_newer = true, .fetch = fetch, .context = fields};
}

static bool send_bricks(struct gas_fields *fields, enum gas_field field, bool extras,
                        struct kiln_error *error)
{
    char *host = kiln_buffer_host(&fields->of[field], KILN_OVERWRITE, error);
    if (host)
        copy_bricks(fields->gas, host, true, extras);
    return host != NULL;
}

/* Sends the diagonals of all levels. */
static bool send_tables(struct gas_fields *fields, const struct gas_levels *levels,
                        struct kiln_error *error)
{
    size_t size = 0;
    for (uint32_t i = 0; i < levels->count; i++)
        size += 18 * (size_t)levels->level[i].row * sizeof(float);
    gas_fields_reserve(fields, GAS_FIELD_TABLES, size);
    char *to = kiln_buffer_host(&fields->of[GAS_FIELD_TABLES], KILN_OVERWRITE, error);
    for (uint32_t i = 0; to && i < levels->count; i++) {
        const size_t bytes = 9 * (size_t)levels->level[i].row * sizeof(float);
        memcpy(to, levels->level[i].diagonal, bytes);
        memcpy(to + bytes, levels->level[i].inverse, bytes);
        to += 2 * bytes;
    }
    return to != NULL;
}

/* Makes the buffers of the window. */
static void make_room(struct gas_fields *fields, const struct gas_levels *levels)
{
    const size_t cells = brick_count(fields->gas) * GAS_BRICK_CELLS;
    const size_t groups = kiln_gas_groups(&fields->gas->shape);
    size_t floats = 0;
    for (uint32_t i = 0; i < levels->count; i++)
        floats += gas_level_floats(&levels->level[i]);
    const size_t sizes[GAS_FIELD_COUNT] = {
        [GAS_FIELD_FACES] = 3 * array_floats(fields->gas) * sizeof(float),
        [GAS_FIELD_CENTRES] = cells * CELL_BYTES,
        [GAS_FIELD_NOW] = cells * CELL_BYTES,
        [GAS_FIELD_AFTER] = cells * CELL_BYTES,
        [GAS_FIELD_TRACED] = 2 * cells * CELL_BYTES,
        [GAS_FIELD_CHANGES] = cells * CELL_BYTES,
        [GAS_FIELD_EXPANDED] = cells * sizeof(float),
        [GAS_FIELD_EXTRAS] = groups * cells * CELL_BYTES,
        [GAS_FIELD_NEXT] = groups * cells * CELL_BYTES,
        [GAS_FIELD_P] = floats * sizeof(float),
        [GAS_FIELD_F] = floats * sizeof(float),
        [GAS_FIELD_FASTEST] = sizeof(uint32_t),
    };
    for (int i = 0; i < GAS_FIELD_COUNT; i++)
        gas_fields_reserve(fields, (enum gas_field)i, sizes[i]);
}

/* Returns whether a storage block may be as large as the largest of the window's. Software GL takes
 * larger ones than it says. */
static bool check_size(const struct gas_fields *fields, struct kiln_error *error)
{
    const struct kiln_device *device = fields->kernels->device;
    const struct kiln_gas_place n = fields->gas->cells;
    GLint64 most = 0;
    size_t largest = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    for (int i = 0; i < GAS_FIELD_COUNT; i++)
        largest = fields->of[i].size > largest ? fields->of[i].size : largest;
    if (device->info.software || largest <= (uint64_t)most)
        return true;
    return kiln_error_set(error, KILN_DEVICE_FAILED,
                          "gas of %d x %d x %d cells takes a buffer of %zu bytes, and %s allows "
                          "%lld; use gas=cpu, or larger cells",
                          n.x, n.y, n.z, largest, device->info.name, (long long)most);
}

static bool fill(struct gas_fields *fields, const struct gas_levels *levels,
                 struct kiln_error *error)
{
    const struct kiln_gas *gas = fields->gas;
    const size_t array = array_floats(gas), bricks = brick_count(gas);
    gas_fields_free_window(fields);
    make_room(fields, levels);
    fields->awake = calloc(bricks, 1);
    fields->words = calloc(11 * bricks, sizeof *fields->words);
    if (!fields->awake || !fields->words)
        return kiln_error_no_memory(error, "gas");
    if (!check_size(fields, error))
        return false;
    float *p = kiln_buffer_host(&fields->of[GAS_FIELD_P], KILN_READ_WRITE, error);
    if (!p || !send_tables(fields, levels, error) ||
        !send_bricks(fields, GAS_FIELD_NOW, false, error) ||
        (kiln_gas_groups(&gas->shape) > 0 && !send_bricks(fields, GAS_FIELD_EXTRAS, true, error)) ||
        !gas_fields_send(fields, GAS_FIELD_FACES, gas->arrays, 3 * array * sizeof(float), error))
        return false;
    memcpy(p, gas->arrays + 3 * array, array * sizeof *p);
    for (size_t i = 0; i < bricks; i++)
        fields->awake[i] = gas->brick[i].chunk != NULL;
    fields->is_filled = true;
    return true;
}

/* ---- bricks ---------------------------------------------------------------------------------- */

static void clear(const struct gas_fields *fields, enum gas_field field, size_t first, size_t bytes)
{
    const GLuint zero = 0;
    if (!fields->of[field].gl)
        return;
    glBindBuffer(GL_COPY_WRITE_BUFFER, fields->of[field].gl);
    glClearBufferSubData(GL_COPY_WRITE_BUFFER, GL_R32UI, (GLintptr)first, (GLsizeiptr)bytes,
                         GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
}

void gas_fields_clear_group(struct gas_fields *fields, uint32_t group)
{
    const size_t groups = kiln_gas_groups(&fields->gas->shape);
    struct kiln_error ignored = {0};
    if (!fields->is_filled ||
        !kiln_buffer_gl(&fields->of[GAS_FIELD_EXTRAS], KILN_READ_WRITE, &ignored))
        return;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    for (size_t i = 0; i < brick_count(fields->gas); i++)
        if (fields->awake[i])
            clear(fields, GAS_FIELD_EXTRAS, (i * groups + group) * BRICK_BYTES, BRICK_BYTES);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

/* Takes everything away from bricks that have fallen idle. */
static void clear_idle(struct gas_fields *fields)
{
    const size_t extras = kiln_gas_groups(&fields->gas->shape) * (size_t)BRICK_BYTES;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    for (size_t i = 0; i < brick_count(fields->gas); i++) {
        const bool awake = fields->gas->brick[i].chunk != NULL;
        if (fields->awake[i] && !awake) {
            clear(fields, GAS_FIELD_NOW, i * BRICK_BYTES, BRICK_BYTES);
            clear(fields, GAS_FIELD_AFTER, i * BRICK_BYTES, BRICK_BYTES);
            if (extras > 0) {
                clear(fields, GAS_FIELD_EXTRAS, i * extras, extras);
                clear(fields, GAS_FIELD_NEXT, i * extras, extras);
            }
        }
        fields->awake[i] = awake;
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

static uint32_t index_of(const struct kiln_gas *gas, gas_brick_place at)
{
    return (uint32_t)kiln_gas_brick_index(gas, at.x, at.y, at.z);
}

/* Returns whether a solid reaches a brick or one around it. */
static bool is_beside_wall(const struct gas_pass *pass, gas_brick_place at)
{
    const struct kiln_gas_place n = pass->gas->bricks;
    for (int i = 0; i < 27; i++) {
        const gas_brick_place b = {at.x + i % 3 - 1, at.y + i / 3 % 3 - 1, at.z + i / 9 - 1};
        if (b.x >= 0 && b.y >= 0 && b.z >= 0 && b.x < n.x && b.y < n.y && b.z < n.z &&
            pass->walls[index_of(pass->gas, b)])
            return true;
    }
    return false;
}

/* Fills in the flags of bricks. */
static void flag_bricks(struct gas_fields *fields, const struct gas_job *job)
{
    const struct kiln_gas *gas = fields->gas;
    uint32_t walls = 0;
    for (size_t i = 0; i < brick_count(gas); i++) {
        const bool active = gas->brick[i].chunk != NULL;
        const bool walled = job->pass->walls && job->pass->walls[i];
        fields->words[i] = (active ? GAS_IS_ACTIVE : 0) |
                           (active || job->solver->blows ? GAS_HAS_CHANGE : 0) |
                           (walled ? ++walls << GAS_WALL_SHIFT : 0);
    }
}

/* Begins a list behind the words so far. */
static struct gas_listed list_at(const uint32_t *words, const uint32_t *end)
{
    return (struct gas_listed){.first = (uint32_t)(end - words)};
}

static void add_to(struct gas_listed *list, uint32_t **end, uint32_t brick, uint32_t number)
{
    *(*end)++ = brick;
    *(*end)++ = number;
    list->count++;
}

/* Lists the bricks of a substep. */
static void list_bricks(struct gas_fields *fields, const struct gas_job *job)
{
    const struct gas_solver *s = job->solver;
    const struct kiln_gas *gas = fields->gas;
    const bool stirs = job->pass->stir.strength > 0.0f || job->pass->step->confinement > 0.0f;
    uint32_t *end = fields->words + brick_count(gas), number = 0;
    fields->active = list_at(fields->words, end);
    for (uint32_t i = 0; i < s->active.count; i++) {
        const uint32_t brick = index_of(gas, s->active.brick[i]);
        add_to(&fields->active, &end, brick, stirs && gas->has_gas[brick] ? ++number : 0);
    }
    fields->stirred = list_at(fields->words, end);
    for (uint32_t i = 0; i < s->active.count; i++) {
        const uint32_t *entry = fields->words + fields->active.first + (size_t)2 * i;
        if (entry[1] > 0)
            add_to(&fields->stirred, &end, entry[0], entry[1]);
    }
    fields->walled = list_at(fields->words, end);
    for (uint32_t i = 0; i < s->active.count && job->pass->walls; i++)
        if (is_beside_wall(job->pass, s->active.brick[i]))
            add_to(&fields->walled, &end, index_of(gas, s->active.brick[i]), 0);
    fields->pushed = list_at(fields->words, end);
    for (uint32_t i = 0; i < s->pushed.count; i++)
        add_to(&fields->pushed, &end, index_of(gas, s->pushed.brick[i]), 0);
    fields->idle = list_at(fields->words, end);
    for (uint32_t i = 0; i < s->pushed.count && s->blows; i++) {
        const uint32_t brick = index_of(gas, s->pushed.brick[i]);
        if (!gas->brick[brick].chunk)
            add_to(&fields->idle, &end, brick, 0);
    }
}

static size_t list_bytes(const struct gas_fields *fields)
{
    return ((size_t)fields->idle.first + (size_t)2 * fields->idle.count) * sizeof *fields->words;
}

/* ---- walls ----------------------------------------------------------------------------------- */

static bool send_wall_words(struct gas_fields *fields, const struct gas_pass *pass,
                            struct kiln_error *error)
{
    const size_t bricks = brick_count(fields->gas);
    size_t walls = 0;
    for (size_t i = 0; i < bricks; i++)
        walls += pass->walls[i] != NULL;
    gas_fields_reserve(fields, GAS_FIELD_WALLS, walls * WALL_BYTES);
    uint32_t *to = kiln_buffer_host(&fields->of[GAS_FIELD_WALLS], KILN_OVERWRITE, error);
    if (!to)
        return false;
    for (size_t i = 0; i < bricks; i++) {
        const struct gas_wall *wall = pass->walls[i];
        if (!wall)
            continue;
        for (int k = 0; k < GAS_BRICK_CELLS; k++)
            to[k] = wall->cell[k];
        memcpy(to + GAS_BRICK_CELLS, wall->open, sizeof wall->open);
        memcpy(to + (size_t)4 * GAS_BRICK_CELLS, wall->speed, sizeof wall->speed);
        to += (size_t)GAS_WALL_WORDS;
    }
    kiln_buffer_set_content(&fields->of[GAS_FIELD_WALLS], walls * WALL_BYTES);
    return true;
}

static bool send_open_faces(struct gas_fields *fields, const struct gas_levels *levels,
                            struct kiln_error *error)
{
    size_t floats = 0, rows = 0;
    for (uint32_t i = 0; i < levels->count; i++) {
        floats += 3 * gas_level_floats(&levels->level[i]);
        rows += (size_t)levels->level[i].cells.y * (size_t)levels->level[i].cells.z;
    }
    gas_fields_reserve(fields, GAS_FIELD_WALLED, rows * sizeof(uint32_t));
    uint32_t *walled = kiln_buffer_host(&fields->of[GAS_FIELD_WALLED], KILN_OVERWRITE, error);
    for (size_t i = 0; walled && i < rows; i++)
        walled[i] = levels->wall_rows[i];
    return walled && gas_fields_send(fields, GAS_FIELD_OPEN, levels->wall_memory,
                                     floats * sizeof(float), error);
}

bool gas_fields_send_walls(struct gas_fields *fields, const struct gas_job *job)
{
    const struct gas_pass *pass = job->pass;
    if (!pass->walls || fields->walls_made == pass->walls_made)
        return true;
    fields->walls_made = pass->walls_made;
    flag_bricks(fields, job);
    return send_wall_words(fields, pass, job->error) &&
           send_open_faces(fields, &job->solver->levels, job->error) &&
           gas_fields_send(fields, GAS_FIELD_BRICKS, fields->words, list_bytes(fields), job->error);
}

/* ---- a substep ------------------------------------------------------------------------------- */

static struct kiln_gas_kernel params_of(const struct gas_fields *fields, const struct gas_job *job)
{
    const struct kiln_gas *gas = fields->gas;
    const struct gas_pass *pass = job->pass;
    const struct gas_lattice *forces = &pass->forces;
    return (struct kiln_gas_kernel){
        .step = *pass->step,
        .turn = FLOAT4(forces->twice_spin[0], forces->twice_spin[1], forces->twice_spin[2],
                       pass->stir.strength),
        .stir = FLOAT4(pass->stir.scale, pass->stir.rise, 1.0f / pass->step->cell, 0.0f),
        .least = FLOAT4(forces->least[0], forces->least[1], forces->least[2], 0.0f),
        .most = FLOAT4(forces->most[0], forces->most[1], forces->most[2], 0.0f),
        .bricks_x = (uint32_t)gas->bricks.x,
        .bricks_y = (uint32_t)gas->bricks.y,
        .bricks_z = (uint32_t)gas->bricks.z,
        .groups = kiln_gas_groups(&gas->shape),
        .at_x = (uint32_t)gas->at.x,
        .at_y = (uint32_t)gas->at.y,
        .at_z = (uint32_t)gas->at.z,
        .first_way = gas->shape.detailed ? kiln_gas_group(&gas->shape, GAS_CAME_FROM) : UINT32_MAX,
        .row = (uint32_t)gas->row,
        .plane = (uint32_t)gas->plane,
        .face = (uint32_t)(gas->faces[0] - gas->arrays),
        .faces = (uint32_t)array_floats(gas),
        .has_forces = forces->points != NULL,
        .lattice_row = forces->row,
        .lattice_plane = forces->plane,
        .octaves = pass->stir.octaves,
        .seed = pass->stir.seed,
        .closed = gas_closed_bits(pass),
    };
}

bool gas_fields_begin(struct gas_fields *fields, const struct gas_job *job)
{
    const struct gas_pass *pass = job->pass;
    const struct kiln_gas_place n = fields->gas->cells;
    struct kiln_error *error = job->error;
    if (fields->is_filled)
        clear_idle(fields);
    else if (!fill(fields, &job->solver->levels, error))
        return false;
    flag_bricks(fields, job);
    list_bricks(fields, job);
    const struct kiln_gas_kernel params = params_of(fields, job);
    const size_t points = ((size_t)n.x / GAS_LATTICE + 1) * ((size_t)n.y / GAS_LATTICE + 1) *
                          ((size_t)n.z / GAS_LATTICE + 1);
    gas_fields_reserve(fields, GAS_FIELD_STIRS,
                       (size_t)fields->stirred.count * GAS_STIR_FLOATS * sizeof(float));
    gas_fields_reserve(fields, GAS_FIELD_FOUND,
                       (size_t)2 * fields->active.count * GAS_BRICK * sizeof(uint4));
    return gas_fields_send_walls(fields, job) &&
           gas_fields_send(fields, GAS_FIELD_BRICKS, fields->words, list_bytes(fields), error) &&
           gas_fields_send(fields, GAS_FIELD_PARAMS, &params, sizeof params, error) &&
           (!pass->forces.points || gas_fields_send(fields, GAS_FIELD_LATTICE, pass->forces.points,
                                                    points * sizeof(float4), error));
}
