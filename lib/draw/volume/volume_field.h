/* A kiln_volume_field holds what the march through a domain of gas reads: blocks of cells with what
 * gas there is, and the light that reaches it. A block is a brick of the domain's window, and one
 * more cell on each of its upper sides, so that a sample between cells reads one block. Rays pass
 * over the cubes of a brick, its eighths, in which nothing is seen. */
#ifndef KILN_DRAW_VOLUME_VOLUME_FIELD_H
#define KILN_DRAW_VOLUME_VOLUME_FIELD_H

#include "base/thread.h"
#include "particles/gas.h"

/* The floats of a drawn cell. */
enum {
    VOLUME_SMOKE,
    VOLUME_FLAME,
    VOLUME_TEMPERATURE,
    VOLUME_SUN,       /* part of the sun's light that is scattered once */
    VOLUME_SCATTERED, /* part of it that is scattered several times */
    VOLUME_RED,       /* light from all sides: radiance */
    VOLUME_GREEN,
    VOLUME_BLUE,
    VOLUME_CELL,
};

/* The floats of a cell that detailed gas is drawn finer by, beside its ways. */
enum {
    VOLUME_SMOKE_THICKNESS, /* amount of smoke by its slope, cells */
    VOLUME_FLAME_THICKNESS,
    VOLUME_CALM, /* 1: the ways of group 0 keep shapes; 0: they tear or shear them. Then group 1 */
};

/* No gas counts as thicker than this. */
#define VOLUME_THICKEST 8.0f

enum {
    VOLUME_EDGE = GAS_BRICK + 1, /* cells along an edge of a block */
    VOLUME_ROW = VOLUME_EDGE * VOLUME_CELL,
    VOLUME_PLANE = VOLUME_EDGE * VOLUME_ROW,
    VOLUME_BLOCK = VOLUME_EDGE * VOLUME_PLANE, /* floats of a block */
    VOLUME_FOUR = 4,                           /* floats of a cell's tint, and of its edges */
    VOLUME_FOURS = VOLUME_BLOCK / VOLUME_CELL * VOLUME_FOUR,
    VOLUME_CUBE = GAS_BRICK / 2, /* cells along an edge of a cube, an eighth of a brick */
    VOLUME_CUBES = 8,            /* of a brick */
};

struct kiln_volume_field {
    const struct kiln_gas *gas;
    struct kiln_gas_place cells, bricks; /* of the window */
    int32_t *block_of; /* of each brick: the number of its block; -1: nothing is seen there */
    int32_t *cube_of;  /* of each cube of the window, row by row: the same */
    uint8_t *seen;     /* scratch: of each brick */
    size_t brick_room; /* elements of block_of and seen; cube_of has VOLUME_CUBES for each */
    int32_t *brick_of; /* of each block */
    float *blocks;
    float *ways;  /* of blocks of detailed gas: both groups of GAS_CAME_FROM, as `blocks` */
    float *edges; /* of the same: VOLUME_FOUR floats a cell */
    float *tints; /* of blocks of coloured gas: what its smoke scatters, rgb and 0, a cell */
    uint32_t count, capacity; /* blocks */
};

/* Says what of gas is seen. */
struct kiln_volume_seen {
    bool detail;                    /* it is drawn finer than its cells */
    float least_smoke, least_flame; /* amounts that count as nothing */
    float albedo[3];                /* of smoke without a colour of its own */
};

/* Finds the bricks in which more gas than this can be seen, and copies their gas to blocks without
 * light. The gas is borrowed until the next call. Returns false with an error when memory is short.
 */
bool kiln_volume_field_fill(struct kiln_volume_field *field, const struct kiln_gas *gas,
                            const struct kiln_volume_seen *seen, struct kiln_threads *threads,
                            struct kiln_error *error);

/* Copies the light of each block's neighbours to the cells that it shares with them. */
void kiln_volume_field_join(struct kiln_volume_field *field, struct kiln_threads *threads);

void kiln_volume_field_finish(struct kiln_volume_field *field);

/* Returns the most bytes of a field of a domain in which so many bricks are active. */
uint64_t kiln_volume_field_bytes(const struct kiln_gas_shape *shape, uint64_t bricks);

/* Returns the place of a block's brick in the window, in bricks. */
static inline struct kiln_gas_place kiln_volume_place(const struct kiln_volume_field *field,
                                                      uint32_t block)
{
    const int32_t brick = field->brick_of[block], nx = field->bricks.x, ny = field->bricks.y;
    return (struct kiln_gas_place){brick % nx, brick / nx % ny, brick / nx / ny};
}

/* Returns the floats of a cell of a block. */
static inline float *kiln_volume_cell(float *block, ptrdiff_t x, ptrdiff_t y, ptrdiff_t z)
{
    return block + x * VOLUME_CELL + y * VOLUME_ROW + z * VOLUME_PLANE;
}

static inline float *kiln_volume_block(const struct kiln_volume_field *field, uint32_t block)
{
    return field->blocks + (size_t)block * VOLUME_BLOCK;
}

#endif
