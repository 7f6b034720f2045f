/* This file allocates, moves, copies and hashes the state of a domain of gas. Chunks of bricks are
 * cut from slabs and reused, since gas wakes and leaves bricks in every step. */
#include "particles/gas.h"

#include <stdlib.h>
#include <string.h>

#include "base/pages.h"
#include "shared/state_hash.h"

enum {
    SLAB_BYTES = 4 << 20, /* two large pages (base/pages.h), of which chunks fill nearly all */
    ARRAYS = 4,           /* three of faces, and pressure */
};

/* The least and the greatest factor on smoke by which a step makes up for the one before. */
#define MOST_LOST   0.98
#define MOST_GAINED 1.02

/* Sizes of an array over a window. */
struct extent {
    ptrdiff_t row, plane;
    size_t floats; /* of the whole array */
    size_t first;  /* place of cell (0, 0, 0) */
};

static struct extent extent_of(struct kiln_gas_place n)
{
    const ptrdiff_t row = kiln_gas_row(n.x);
    const ptrdiff_t plane = row * (n.y + 2);
    return (struct extent){row, plane, (size_t)plane * (size_t)(n.z + 2) + 2 * (size_t)KILN_GAS_PAD,
                           (size_t)(plane + row) + KILN_GAS_PAD};
}

enum { ROWS_OF_BRICK = GAS_BRICK * GAS_BRICK };

/* Floats of a chunk's parts. */
static size_t joined_floats(void)
{
    return (size_t)ROWS_OF_BRICK * GAS_ROW_CELLS * GAS_TRACED;
}

static size_t extra_floats(const struct kiln_gas_shape *shape)
{
    return (size_t)kiln_gas_groups(shape) * GAS_CARRIED * GAS_BRICK_CELLS;
}

static size_t chunk_floats(const struct kiln_gas_shape *shape)
{
    return (size_t)GAS_BRICK_CELLS * (GAS_CARRIED + GAS_CHANGE) + 2 * joined_floats() +
           2 * extra_floats(shape);
}

static size_t brick_count(struct kiln_gas_place bricks)
{
    return (size_t)bricks.x * (size_t)bricks.y * (size_t)bricks.z;
}

uint64_t kiln_gas_window_bytes(struct kiln_gas_place cells)
{
    const struct kiln_gas_place bricks = {cells.x / GAS_BRICK, cells.y / GAS_BRICK,
                                          cells.z / GAS_BRICK};
    return ARRAYS * extent_of(cells).floats * sizeof(float) +
           brick_count(bricks) * (sizeof(struct kiln_gas_brick) + 1);
}

uint64_t kiln_gas_brick_bytes(const struct kiln_gas_shape *shape)
{
    return chunk_floats(shape) * sizeof(float);
}

void kiln_gas_closed(const struct kiln_gas *gas, bool closed[6])
{
    const struct kiln_gas_place all = gas->shape.cells, at = gas->at, n = gas->cells;
    const bool at_side[6] = {at.x == 0,           at.x + n.x == all.x, at.y == 0,
                             at.y + n.y == all.y, at.z == 0,           at.z + n.z == all.z};
    for (int i = 0; i < 6; i++)
        closed[i] = at_side[i] && gas->shape.closed[i];
}

void kiln_gas_init(struct kiln_gas *gas, const struct kiln_gas_shape *shape)
{
    *gas = (struct kiln_gas){.shape = *shape, .kept = 1.0f};
}

void kiln_gas_finish(struct kiln_gas *gas)
{
    for (uint32_t i = 0; i < gas->slab_count; i++)
        free(gas->slabs[i]);
    free(gas->slabs);
    free(gas->arrays);
    free(gas->brick);
    free(gas->has_gas);
    *gas = (struct kiln_gas){.arrays = NULL};
}

bool kiln_gas_fetch(struct kiln_gas *gas, struct kiln_error *error)
{
    if (gas->away.is_newer && !gas->away.fetch(gas->away.context, error))
        return false;
    gas->away.is_newer = false;
    return true;
}

/* ---- chunks ---------------------------------------------------------------------------------- */

static void put_back(struct kiln_gas *gas, float *chunk)
{
    memcpy(chunk, &gas->free_chunks, sizeof gas->free_chunks);
    gas->free_chunks = chunk;
}

static bool cut_slab(struct kiln_gas *gas)
{
    const size_t floats = chunk_floats(&gas->shape);
    float **slabs = realloc(gas->slabs, (gas->slab_count + 1) * sizeof *slabs);
    if (!slabs)
        return false;
    gas->slabs = slabs;
    const size_t chunks = (SLAB_BYTES - 1) / (floats * sizeof(float));
    float *slab = kiln_alloc_pages(chunks * floats * sizeof *slab);
    if (!slab)
        return false;
    slabs[gas->slab_count++] = slab;
    for (size_t i = chunks; i-- > 0;)
        put_back(gas, slab + i * floats);
    return true;
}

bool kiln_gas_brick_take(struct kiln_gas *gas, struct kiln_gas_brick *brick)
{
    if (brick->chunk)
        return true;
    if (!gas->free_chunks && !cut_slab(gas))
        return false;
    float *chunk = gas->free_chunks;
    memcpy(&gas->free_chunks, chunk, sizeof gas->free_chunks);
    const size_t carried = (size_t)GAS_CARRIED * GAS_BRICK_CELLS;
    const size_t extras = extra_floats(&gas->shape);
    brick->chunk = chunk;
    brick->joined = chunk;
    brick->traced = brick->joined + joined_floats();
    brick->now = brick->traced + joined_floats();
    brick->change = brick->now + carried;
    brick->extras = extras > 0 ? brick->change + (size_t)GAS_CHANGE * GAS_BRICK_CELLS : NULL;
    brick->next_extras = extras > 0 ? brick->extras + extras : NULL;
    memset(brick->now, 0, carried * sizeof *chunk);
    if (extras > 0)
        memset(brick->extras, 0, extras * sizeof *chunk);
    return true;
}

void kiln_gas_brick_free(struct kiln_gas *gas, struct kiln_gas_brick *brick)
{
    if (brick->chunk)
        put_back(gas, brick->chunk);
    *brick = (struct kiln_gas_brick){.chunk = NULL};
}

/* ---- windows --------------------------------------------------------------------------------- */

/* Holds the cells of a domain that two windows share, on one axis: from `first` on in each of them.
 */
struct shared {
    int32_t count, from, to;
};

static struct shared shared_of(int32_t old, int32_t old_count, int32_t new, int32_t new_count)
{
    const int32_t begin = old > new ? old : new;
    const int32_t old_end = old + old_count, new_end = new + new_count;
    const int32_t end = old_end < new_end ? old_end : new_end;
    return (struct shared){end > begin ? end - begin : 0, begin - old, begin - new};
}

static struct kiln_gas_place bricks_of(struct kiln_gas_place cells)
{
    return (struct kiln_gas_place){cells.x / GAS_BRICK, cells.y / GAS_BRICK, cells.z / GAS_BRICK};
}

static void copy_rows(float *to, const struct extent *at, const float *from,
                      const struct kiln_gas *old, const struct shared s[3], int axis)
{
    const int32_t more[3] = {axis == 0, axis == 1, axis == 2};
    for (int32_t z = 0; z < s[2].count + more[2]; z++)
        for (int32_t y = 0; y < s[1].count + more[1]; y++)
            memcpy(to + (s[2].to + z) * at->plane + (s[1].to + y) * at->row + s[0].to,
                   from + (s[2].from + z) * old->plane + (s[1].from + y) * old->row + s[0].from,
                   (size_t)(s[0].count + more[0]) * sizeof *to);
}

/* Pressure has the cells of even and of odd x in halves of its rows. */
static void copy_pressure(float *to, const struct extent *at, const struct kiln_gas *old,
                          const struct shared s[3])
{
    for (int32_t z = 0; z < s[2].count; z++)
        for (int32_t y = 0; y < s[1].count; y++)
            for (int32_t odd = 0; odd < 2; odd++)
                memcpy(to + (s[2].to + z) * at->plane + (s[1].to + y) * at->row +
                           odd * (at->row / 2) + s[0].to / 2,
                       old->pressure + (s[2].from + z) * old->plane + (s[1].from + y) * old->row +
                           odd * (old->row / 2) + s[0].from / 2,
                       (size_t)(s[0].count / 2) * sizeof *to);
}

static void move_bricks(struct kiln_gas *gas, const struct kiln_gas *old, const struct shared s[3])
{
    const int32_t nx = s[0].count / GAS_BRICK;
    for (int32_t z = 0; z < s[2].count / GAS_BRICK; z++)
        for (int32_t y = 0; y < s[1].count / GAS_BRICK; y++) {
            const size_t from = kiln_gas_brick_index(
                old, s[0].from / GAS_BRICK, s[1].from / GAS_BRICK + y, s[2].from / GAS_BRICK + z);
            const size_t to = kiln_gas_brick_index(
                gas, s[0].to / GAS_BRICK, s[1].to / GAS_BRICK + y, s[2].to / GAS_BRICK + z);
            memcpy(gas->brick + to, old->brick + from, (size_t)nx * sizeof *gas->brick);
            memset(old->brick + from, 0, (size_t)nx * sizeof *old->brick);
            memcpy(gas->has_gas + to, old->has_gas + from, (size_t)nx);
        }
}

bool kiln_gas_set_window(struct kiln_gas *gas, struct kiln_gas_place at,
                         struct kiln_gas_place cells)
{
    struct kiln_gas old = *gas;
    const struct extent extent = extent_of(cells);
    const size_t count = brick_count(bricks_of(cells));
    float *arrays = kiln_alloc_pages(ARRAYS * extent.floats * sizeof *arrays);
    struct kiln_gas_brick *brick = calloc(count, sizeof *brick);
    uint8_t *has_gas = calloc(count, 1);
    if (!arrays || !brick || !has_gas) {
        free(arrays);
        free(brick);
        free(has_gas);
        return false;
    }
    memset(arrays, 0, ARRAYS * extent.floats * sizeof *arrays);
    gas->window++;
    gas->away.is_newer = false;
    gas->at = at;
    gas->cells = cells;
    gas->bricks = bricks_of(cells);
    gas->row = extent.row;
    gas->plane = extent.plane;
    gas->arrays = arrays;
    gas->brick = brick;
    gas->has_gas = has_gas;
    for (int i = 0; i < 3; i++)
        gas->faces[i] = arrays + (size_t)i * extent.floats + extent.first;
    gas->pressure = arrays + 3 * extent.floats + extent.first;
    const struct shared s[3] = {shared_of(old.at.x, old.cells.x, at.x, cells.x),
                                shared_of(old.at.y, old.cells.y, at.y, cells.y),
                                shared_of(old.at.z, old.cells.z, at.z, cells.z)};
    if (s[0].count > 0 && s[1].count > 0 && s[2].count > 0) {
        for (int i = 0; i < 3; i++)
            copy_rows(gas->faces[i], &extent, old.faces[i], &old, s, i);
        copy_pressure(gas->pressure, &extent, &old, s);
        move_bricks(gas, &old, s);
    }
    for (size_t i = 0; i < brick_count(old.bricks); i++)
        kiln_gas_brick_free(gas, &old.brick[i]);
    free(old.arrays);
    free(old.brick);
    free(old.has_gas);
    return true;
}

bool kiln_gas_is_at_opening(const struct kiln_gas *gas, struct kiln_gas_place brick)
{
    const struct kiln_gas_place n = gas->bricks;
    bool closed[6];
    kiln_gas_closed(gas, closed);
    return (brick.x == 0 && !closed[0]) || (brick.x + 1 == n.x && !closed[1]) ||
           (brick.y == 0 && !closed[2]) || (brick.y + 1 == n.y && !closed[3]) ||
           (brick.z == 0 && !closed[4]) || (brick.z + 1 == n.z && !closed[5]);
}

void kiln_gas_keep_smoke(struct kiln_gas *gas, double moved, double smoke, double growth, float dt,
                         bool leaves)
{
    const double expected = gas->smoke + gas->growth * (double)dt;
    const bool known = moved > 0.0 && expected > 0.0 && smoke > 0.0 && !leaves;
    const double made = smoke - moved * (double)gas->kept;
    const double due = gas->due + gas->growth * (double)dt + made;
    const double factor = known ? expected / moved * (due / smoke) : 1.0;
    gas->due = known ? due : smoke;
    gas->kept = (float)(factor < MOST_LOST     ? MOST_LOST
                        : factor > MOST_GAINED ? MOST_GAINED
                                               : factor);
    gas->smoke = smoke;
    gas->growth = growth;
}

bool kiln_gas_copy(struct kiln_gas *to, const struct kiln_gas *from)
{
    for (size_t i = 0; i < brick_count(to->bricks); i++)
        kiln_gas_brick_free(to, &to->brick[i]);
    if (!kiln_gas_set_window(to, from->at, from->cells))
        return false;
    const size_t floats = (size_t)GAS_CARRIED * GAS_BRICK_CELLS;
    const size_t extras = extra_floats(&from->shape);
    memcpy(to->arrays, from->arrays, ARRAYS * extent_of(from->cells).floats * sizeof *to->arrays);
    memcpy(to->has_gas, from->has_gas, brick_count(from->bricks));
    to->fastest = from->fastest;
    to->smoke = from->smoke;
    to->growth = from->growth;
    to->due = from->due;
    to->kept = from->kept;
    for (size_t i = 0; i < brick_count(from->bricks); i++) {
        if (!from->brick[i].now)
            continue;
        if (!kiln_gas_brick_take(to, &to->brick[i]))
            return false;
        memcpy(to->brick[i].now, from->brick[i].now, floats * sizeof(float));
        if (extras > 0)
            memcpy(to->brick[i].extras, from->brick[i].extras, extras * sizeof(float));
    }
    return true;
}

/* ---- hashes ---------------------------------------------------------------------------------- */

/* Adds numbers of a kind to the sums. Zeros add nothing. place: of the first one. */
static void add_numbers(struct kiln_state_hash *hash, uint32_t kind, uint32_t place,
                        const float *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t word = FLOAT_BITS(numbers[i]);
        struct state_hash_lanes lanes = {kind + 0x67617320u, kind + 0x666c6f77u};
        if (word == 0)
            continue;
        lanes = state_hash_word(lanes, place + (uint32_t)i);
        lanes = state_hash_word(lanes, word);
        hash->lane[0] += lanes.a;
        hash->lane[1] += lanes.b;
    }
}

void kiln_gas_hash(const struct kiln_gas *gas, uint32_t number, struct kiln_state_hash *hash)
{
    const struct kiln_gas_place n = gas->cells, all = gas->shape.cells;
    const uint32_t kind = number << 8;
    const size_t floats = (size_t)GAS_CARRIED * GAS_BRICK_CELLS;
    const size_t extras = extra_floats(&gas->shape);
    for (int32_t z = 0; z <= n.z && n.z > 0; z++)
        for (int32_t y = 0; y <= n.y; y++) {
            const ptrdiff_t row = z * gas->plane + y * gas->row;
            const uint32_t place =
                (uint32_t)(((gas->at.z + z) * (all.y + 1) + gas->at.y + y) * (all.x + 1) +
                           gas->at.x);
            for (uint32_t i = 0; i < 3; i++)
                add_numbers(hash, kind + i, place, gas->faces[i] + row,
                            (size_t)n.x + (i == 0 ? 1 : 0));
        }
    for (int32_t z = 0; z < gas->bricks.z; z++)
        for (int32_t y = 0; y < gas->bricks.y; y++)
            for (int32_t x = 0; x < gas->bricks.x; x++) {
                const struct kiln_gas_brick *brick =
                    &gas->brick[kiln_gas_brick_index(gas, x, y, z)];
                const struct kiln_gas_place at = {gas->at.x / GAS_BRICK + x,
                                                  gas->at.y / GAS_BRICK + y,
                                                  gas->at.z / GAS_BRICK + z};
                const uint32_t place =
                    (uint32_t)((at.z * (all.y / GAS_BRICK) + at.y) * (all.x / GAS_BRICK) + at.x) *
                    (uint32_t)(floats + extras);
                if (!brick->now)
                    continue;
                add_numbers(hash, kind + 3, place, brick->now, floats);
                if (extras > 0)
                    add_numbers(hash, kind + 4, place, brick->extras, extras);
            }
}
