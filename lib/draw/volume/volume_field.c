/* This file copies gas from the bricks of a domain's state to the blocks that are drawn. A brick
 * has a block if gas is seen in it, or in one of its upper neighbours, since samples between their
 * cells read the block of the lower one. */
#include "draw/volume/volume_field.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/pages.h"

static size_t count_of(struct kiln_gas_place bricks)
{
    return (size_t)bricks.x * (size_t)bricks.y * (size_t)bricks.z;
}

uint64_t kiln_volume_field_bytes(const struct kiln_gas_shape *shape, uint64_t bricks)
{
    const uint64_t blocks = shape->detailed ? 2 : 1;
    const uint64_t floats = blocks * VOLUME_BLOCK + (shape->colored ? VOLUME_TINTS : 0);
    return bricks * (floats * sizeof(float) + 2 * sizeof(int32_t) + 1);
}

void kiln_volume_field_finish(struct kiln_volume_field *field)
{
    free(field->block_of);
    free(field->seen);
    free(field->brick_of);
    free(field->blocks);
    free(field->tints);
    free(field->ways);
    *field = (struct kiln_volume_field){.gas = NULL};
}

static bool no_memory(struct kiln_volume_field *field, struct kiln_error *error)
{
    kiln_volume_field_finish(field);
    return kiln_error_no_memory(error, "drawn gas");
}

/* ---- bricks that are seen -------------------------------------------------------------------- */

struct scan_job {
    struct kiln_volume_field *field;
    const struct kiln_volume_seen *seen;
};

static void scan_bricks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct scan_job *job = context;
    for (size_t i = begin; i < end; i++) {
        const float *cells = job->field->gas->brick[i].now;
        bool seen = false;
        for (int k = 0; k < GAS_BRICK_CELLS && cells && !seen; k++)
            seen = cells[k * GAS_CARRIED + GAS_SMOKE] > job->seen->least_smoke ||
                   cells[k * GAS_CARRIED + GAS_FLAME] > job->seen->least_flame;
        job->field->seen[i] = seen;
    }
}

/* Returns whether gas is seen in a brick or one of its upper neighbours. */
static bool is_drawn(const struct kiln_volume_field *field, struct kiln_gas_place at)
{
    const struct kiln_gas_place n = field->bricks;
    for (int32_t z = at.z; z <= at.z + 1 && z < n.z; z++)
        for (int32_t y = at.y; y <= at.y + 1 && y < n.y; y++)
            for (int32_t x = at.x; x <= at.x + 1 && x < n.x; x++)
                if (field->seen[kiln_gas_brick_index(field->gas, x, y, z)])
                    return true;
    return false;
}

static uint32_t number_blocks(struct kiln_volume_field *field)
{
    const struct kiln_gas_place n = field->bricks;
    int32_t *block_of = field->block_of;
    int32_t count = 0;
    for (int32_t z = 0; z < n.z; z++)
        for (int32_t y = 0; y < n.y; y++)
            for (int32_t x = 0; x < n.x; x++)
                *block_of++ = is_drawn(field, (struct kiln_gas_place){x, y, z}) ? count++ : -1;
    return (uint32_t)count;
}

static bool make_room(struct kiln_volume_field *field, size_t bricks)
{
    if (bricks <= field->brick_room)
        return true;
    free(field->block_of);
    free(field->seen);
    field->block_of = malloc(bricks * sizeof *field->block_of);
    field->seen = malloc(bricks);
    field->brick_room = bricks;
    return field->block_of && field->seen;
}

static bool make_block_room(struct kiln_volume_field *field, bool detail)
{
    const bool colored = field->gas->shape.colored;
    if (field->count <= field->capacity && (field->tints || !colored) && (field->ways || !detail))
        return true;
    const size_t most = count_of(field->bricks);
    size_t room = field->count + field->count / 4;
    room = room < most ? room : most;
    free(field->blocks);
    free(field->brick_of);
    free(field->tints);
    free(field->ways);
    field->tints = colored ? kiln_alloc_pages(room * VOLUME_TINTS * sizeof *field->tints) : NULL;
    field->ways = detail ? kiln_alloc_pages(room * VOLUME_BLOCK * sizeof *field->ways) : NULL;
    field->blocks = kiln_alloc_pages(room * VOLUME_BLOCK * sizeof *field->blocks);
    field->brick_of = malloc(room * sizeof *field->brick_of);
    field->capacity = (uint32_t)room;
    return field->blocks && field->brick_of && (field->tints || !colored) &&
           (field->ways || !detail);
}

/* ---- blocks ---------------------------------------------------------------------------------- */

/* Returns the cell of the window that a cell of a block shows; the last one beyond its end. */
static int32_t cell_of(int32_t brick, int32_t cell, int32_t count)
{
    const int32_t at = brick * GAS_BRICK + cell;
    return at < count ? at : count - 1;
}

/* Writes what the smoke of a cell scatters: its amount times its albedo. color: GAS_COLOR. */
static void write_tint(const float *color, float smoke, const float albedo[3], float *tint)
{
    const float amount = color[3], part = amount < smoke ? amount : smoke;
    tint[3] = 0.0f;
    for (int c = 0; c < 3; c++)
        tint[c] = amount > 1e-6f ? (smoke - part) * albedo[c] + part / amount * color[c]
                                 : smoke * albedo[c];
}

/* The cells of a block that are being filled; NULL: not needed. */
struct filled {
    float *cell, *tint, *way;
};

/* Copies the gas of a cell of the window. */
static void copy_cell(const struct scan_job *job, struct kiln_gas_place at, struct filled to)
{
    const struct kiln_gas *gas = job->field->gas;
    const struct kiln_gas_brick *brick = &gas->brick[kiln_gas_brick_index(
        gas, at.x / GAS_BRICK, at.y / GAS_BRICK, at.z / GAS_BRICK)];
    const ptrdiff_t row = at.z % GAS_BRICK * GAS_BRICK + at.y % GAS_BRICK;
    const ptrdiff_t in = (row * GAS_BRICK + at.x % GAS_BRICK) * GAS_CARRIED;
    memset(to.cell, 0, VOLUME_CELL * sizeof *to.cell);
    if (to.tint)
        memset(to.tint, 0, VOLUME_TINT * sizeof *to.tint);
    if (to.way)
        memset(to.way, 0, VOLUME_CELL * sizeof *to.way);
    if (!brick->now)
        return;
    const float *from = brick->now + in;
    to.cell[VOLUME_SMOKE] = from[GAS_SMOKE];
    to.cell[VOLUME_FLAME] = from[GAS_FLAME];
    to.cell[VOLUME_TEMPERATURE] = from[GAS_TEMPERATURE];
    const float *extras = brick->extras ? brick->extras + in : NULL;
    const size_t group = (size_t)GAS_BRICK_CELLS * GAS_CARRIED;
    if (to.tint)
        write_tint(extras + kiln_gas_group(&gas->shape, GAS_COLOR) * group, from[GAS_SMOKE],
                   job->seen->albedo, to.tint);
    for (size_t i = 0; i < 2 && to.way; i++)
        memcpy(to.way + i * GAS_CARRIED,
               extras + (kiln_gas_group(&gas->shape, GAS_CAME_FROM) + i) * group,
               GAS_CARRIED * sizeof *extras);
}

static void copy_gas(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct scan_job *job = context;
    const struct kiln_volume_field *field = job->field;
    const bool colored = field->gas->shape.colored, detail = job->seen->detail;
    for (size_t i = begin; i < end; i++) {
        const struct kiln_gas_place b = kiln_volume_place(field, (uint32_t)i);
        for (size_t k = 0; k < VOLUME_BLOCK / VOLUME_CELL; k++) {
            const int32_t n = (int32_t)k;
            const struct kiln_gas_place at = {
                cell_of(b.x, n % VOLUME_EDGE, field->cells.x),
                cell_of(b.y, n / VOLUME_EDGE % VOLUME_EDGE, field->cells.y),
                cell_of(b.z, n / (VOLUME_EDGE * VOLUME_EDGE), field->cells.z)};
            copy_cell(
                job, at,
                (struct filled){
                    .cell = field->blocks + i * VOLUME_BLOCK + k * VOLUME_CELL,
                    .tint = colored ? field->tints + i * VOLUME_TINTS + k * VOLUME_TINT : NULL,
                    .way = detail ? field->ways + i * VOLUME_BLOCK + k * VOLUME_CELL : NULL});
        }
    }
}

bool kiln_volume_field_fill(struct kiln_volume_field *field, const struct kiln_gas *gas,
                            const struct kiln_volume_seen *seen, struct kiln_threads *threads,
                            struct kiln_error *error)
{
    const size_t bricks = count_of(gas->bricks);
    struct scan_job job = {field, seen};
    field->gas = gas;
    field->cells = gas->cells;
    field->bricks = gas->bricks;
    field->count = 0;
    if (!make_room(field, bricks))
        return no_memory(field, error);
    kiln_threads_for(threads, bricks, 64, scan_bricks, &job);
    field->count = number_blocks(field);
    if (!make_block_room(field, seen->detail))
        return no_memory(field, error);
    for (size_t i = 0; i < bricks; i++)
        if (field->block_of[i] >= 0)
            field->brick_of[field->block_of[i]] = (int32_t)i;
    kiln_threads_for(threads, field->count, 8, copy_gas, &job);
    return true;
}

/* ---- shared cells ---------------------------------------------------------------------------- */

/* Returns the cell that has the light of a cell of a block: its own, one of an upper neighbour, or,
 * where that is not drawn, the nearest cell of the block itself. */
static const float *light_of(const struct kiln_volume_field *field, uint32_t block,
                             struct kiln_gas_place brick, int32_t x, int32_t y, int32_t z)
{
    const int32_t up[3] = {x / GAS_BRICK, y / GAS_BRICK, z / GAS_BRICK};
    const struct kiln_gas_place at = {brick.x + up[0], brick.y + up[1], brick.z + up[2]};
    int32_t other = -1;
    if (at.x < field->bricks.x && at.y < field->bricks.y && at.z < field->bricks.z)
        other = field->block_of[kiln_gas_brick_index(field->gas, at.x, at.y, at.z)];
    const int32_t last = GAS_BRICK - 1;
    if (other >= 0)
        return kiln_volume_cell(kiln_volume_block(field, (uint32_t)other), up[0] ? 0 : x,
                                up[1] ? 0 : y, up[2] ? 0 : z);
    return kiln_volume_cell(kiln_volume_block(field, block), up[0] ? last : x, up[1] ? last : y,
                            up[2] ? last : z);
}

static void join_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_volume_field *field = context;
    for (size_t i = begin; i < end; i++) {
        const struct kiln_gas_place brick = kiln_volume_place(field, (uint32_t)i);
        float *to = kiln_volume_block(field, (uint32_t)i);
        for (int32_t z = 0; z < VOLUME_EDGE; z++)
            for (int32_t y = 0; y < VOLUME_EDGE; y++)
                for (int32_t x = 0; x < VOLUME_EDGE; x++, to += VOLUME_CELL) {
                    if (x < GAS_BRICK && y < GAS_BRICK && z < GAS_BRICK)
                        continue;
                    const float *from = light_of(field, (uint32_t)i, brick, x, y, z);
                    memcpy(to + VOLUME_SUN, from + VOLUME_SUN,
                           (VOLUME_CELL - VOLUME_SUN) * sizeof *to);
                }
    }
}

void kiln_volume_field_join(struct kiln_volume_field *field, struct kiln_threads *threads)
{
    kiln_threads_for(threads, field->count, 8, join_blocks, field);
}
