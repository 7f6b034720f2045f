/* This file finds the bricks of a domain that are drawn, and keeps their blocks. A brick has a
 * block if gas is seen in it; or in one of its upper neighbours, since samples between their cells
 * read the block of the lower one; or in the last cells of a lower neighbour, whose gas the filter
 * of volume_copy.c spreads to the brick. */
#include "draw/volume/volume_field.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/pages.h"
#include "draw/volume/volume_copy.h"

static size_t count_of(struct kiln_gas_place bricks)
{
    return (size_t)bricks.x * (size_t)bricks.y * (size_t)bricks.z;
}

uint64_t kiln_volume_field_bytes(const struct kiln_gas_shape *shape, uint64_t bricks)
{
    const uint64_t finer = shape->detailed ? VOLUME_BLOCK + VOLUME_FOURS : 0;
    const uint64_t floats = VOLUME_BLOCK + finer + (shape->colored ? VOLUME_FOURS : 0);
    return bricks * (floats * sizeof(float) + (2 + VOLUME_CUBES) * sizeof(int32_t) + 1);
}

void kiln_volume_field_finish(struct kiln_volume_field *field)
{
    free(field->block_of);
    free(field->cube_of);
    free(field->seen);
    free(field->brick_of);
    free(field->blocks);
    free(field->tints);
    free(field->ways);
    free(field->edges);
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

/* Says where in a brick gas is seen: anywhere, or also in its last cells along an axis. */
enum { SEEN = 1, SEEN_LAST_X = 2, SEEN_LAST_Y = 4, SEEN_LAST_Z = 8 };

static void scan_bricks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct scan_job *job = context;
    const int last = GAS_BRICK - 1;
    for (size_t i = begin; i < end; i++) {
        const float *cells = job->field->gas->brick[i].now;
        uint8_t seen = 0;
        for (int k = 0; k < GAS_BRICK_CELLS && cells; k++) {
            if (!(cells[k * GAS_CARRIED + GAS_SMOKE] > job->seen->least_smoke ||
                  cells[k * GAS_CARRIED + GAS_FLAME] > job->seen->least_flame))
                continue;
            const int x = k % GAS_BRICK, y = k / GAS_BRICK % GAS_BRICK;
            const int z = k / (GAS_BRICK * GAS_BRICK);
            seen |= (uint8_t)(SEEN | (x == last ? SEEN_LAST_X : 0) | (y == last ? SEEN_LAST_Y : 0) |
                              (z == last ? SEEN_LAST_Z : 0));
        }
        job->field->seen[i] = seen;
    }
}

/* Returns whether gas of a neighbour of a brick is drawn in its block. step: to the neighbour. */
static bool reaches(const struct kiln_volume_field *field, struct kiln_gas_place brick,
                    struct kiln_gas_place step)
{
    const struct kiln_gas_place n = field->bricks;
    const struct kiln_gas_place at = {brick.x + step.x, brick.y + step.y, brick.z + step.z};
    if (at.x < 0 || at.y < 0 || at.z < 0 || at.x >= n.x || at.y >= n.y || at.z >= n.z)
        return false;
    const uint8_t seen = field->seen[kiln_gas_brick_index(field->gas, at.x, at.y, at.z)];
    const uint8_t needed =
        (uint8_t)(SEEN | (step.x < 0 ? SEEN_LAST_X : 0) | (step.y < 0 ? SEEN_LAST_Y : 0) |
                  (step.z < 0 ? SEEN_LAST_Z : 0));
    return (seen & needed) == needed;
}

static bool is_drawn(const struct kiln_volume_field *field, struct kiln_gas_place at)
{
    for (int32_t k = 0; k < 27; k++)
        if (reaches(field, at, (struct kiln_gas_place){k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1}))
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
    free(field->cube_of);
    free(field->seen);
    field->block_of = malloc(bricks * sizeof *field->block_of);
    field->cube_of = malloc(bricks * VOLUME_CUBES * sizeof *field->cube_of);
    field->seen = malloc(bricks);
    field->brick_room = bricks;
    return field->block_of && field->cube_of && field->seen;
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
    free(field->edges);
    field->tints = colored ? kiln_alloc_pages(room * VOLUME_FOURS * sizeof *field->tints) : NULL;
    field->ways = detail ? kiln_alloc_pages(room * VOLUME_BLOCK * sizeof *field->ways) : NULL;
    field->edges = detail ? kiln_alloc_pages(room * VOLUME_FOURS * sizeof *field->edges) : NULL;
    field->blocks = kiln_alloc_pages(room * VOLUME_BLOCK * sizeof *field->blocks);
    field->brick_of = malloc(room * sizeof *field->brick_of);
    field->capacity = (uint32_t)room;
    return field->blocks && field->brick_of && (field->tints || !colored) &&
           ((field->ways && field->edges) || !detail);
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
    memset(field->cube_of, 0xff, bricks * VOLUME_CUBES * sizeof *field->cube_of);
    kiln_volume_copy(field, seen, threads);
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
