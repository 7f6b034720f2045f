/* Traces gas beside solids: its way ends at a face that is shut, and a value is mixed from the
 * cells on its own side alone (Guendelman et al., "Coupling Water and Smoke to Thin Deformable and
 * Rigid Shells", 2005). Only advect_simd.c includes this header. It works cell by cell, since few
 * cells are near solids. */
#ifndef KILN_SIM_GAS_WALLS_H
#define KILN_SIM_GAS_WALLS_H

#include "sim/gas/block.h"

enum { WALL_ROW = GAS_EDGE, WALL_PLANE = GAS_EDGE * GAS_EDGE };

static const int32_t WALL_STEP[3] = {1, WALL_ROW, WALL_PLANE};
static const uint8_t WALL_SHUT[3] = {GAS_SHUT_X, GAS_SHUT_Y, GAS_SHUT_Z};

/* Returns the place of a brick's cell in its block. */
static int32_t wall_at(int32_t x, int32_t y, int32_t z)
{
    return (z + BELOW) * WALL_PLANE + (y + BELOW) * WALL_ROW + x + BELOW;
}

/* Fills the bits of a row of a block's cells. Returns a bit for each cell that has some. */
static uint32_t gather_wall_row(const struct around *around, int32_t y, int32_t z, uint8_t *to)
{
    const struct gas_wall *const *walls = around->wall[around->z.brick[z]][around->y.brick[y]];
    const int32_t first = (around->z.cell[z] * GAS_BRICK + around->y.cell[y]) * GAS_BRICK;
    uint32_t some = 0;
    memset(to, 0, GAS_EDGE);
    if (!walls[0] && !walls[1] && !walls[2])
        return 0;
    for (int32_t x = 0; x < GAS_EDGE; x++) {
        const struct gas_wall *wall = walls[around->x.brick[x]];
        to[x] = wall ? wall->cell[first + around->x.cell[x]] : 0;
        some |= (uint32_t)(to[x] != 0) << x;
    }
    return some;
}

/* Marks cells of the brick whose gas may come from or go to cells with faces that are shut. some: a
 * bit for each cell of the block's rows that has any. */
static void find_near_walls(uint32_t some[GAS_EDGE][GAS_EDGE], struct gas_workspace *space)
{
    enum { SPAN = 2 * BELOW + 2 };
    uint32_t wide[GAS_EDGE][GAS_BRICK] = {{0}}; /* of cells that are near along x and y */
    for (int32_t z = 0; z < GAS_EDGE; z++)
        for (int32_t y = 0; y < GAS_BRICK; y++)
            for (int32_t j = 0; j < SPAN; j++)
                for (int32_t i = 0; i < SPAN; i++)
                    wide[z][y] |= some[z][y + j] >> i;
    for (int32_t z = 0; z < GAS_BRICK; z++)
        for (int32_t y = 0; y < GAS_BRICK; y++) {
            uint32_t near = 0;
            for (int32_t k = 0; k < SPAN; k++)
                near |= wide[z + k][y];
            space->near_wall[z][y] = (uint8_t)near;
        }
}

/* Fills the bits of a block's cells, and finds the cells of its brick that are near walls. Beyond
 * the window, they are those of the nearest cell. */
static void gather_walls(const struct around *around, struct gas_workspace *space)
{
    uint32_t some[GAS_EDGE][GAS_EDGE];
    for (int32_t z = 0; z < GAS_EDGE; z++)
        for (int32_t y = 0; y < GAS_EDGE; y++)
            some[z][y] = gather_wall_row(
                around, y, z, space->wall + (ptrdiff_t)z * WALL_PLANE + (ptrdiff_t)y * WALL_ROW);
    find_near_walls(some, space);
}

static bool is_near_wall(const struct gas_workspace *space, int32_t x, int32_t y, int32_t z)
{
    return space->near_wall[z][y] >> x & 1;
}

/* Returns whether the face between a cell and the next one on an axis is shut. way: 1 or -1. */
static bool is_shut(const uint8_t *wall, int32_t cell, int axis, int32_t way)
{
    return wall[way > 0 ? cell + WALL_STEP[axis] : cell] & WALL_SHUT[axis];
}

/* Returns whether gas can go from a cell to one beside it: by its sides in the order of the axes,
 * or in the opposite order. way: -1, 0 or 1 on each axis. */
static bool is_seen(const uint8_t *wall, int32_t cell, const int32_t way[3])
{
    bool there = true, back = true;
    int32_t at = cell, from = cell;
    for (int axis = 0; axis < 3; axis++) {
        const int last = 2 - axis;
        there = there && !(way[axis] && is_shut(wall, at, axis, way[axis]));
        back = back && !(way[last] && is_shut(wall, from, last, way[last]));
        at += way[axis] * WALL_STEP[axis];
        from += way[last] * WALL_STEP[last];
    }
    return there || back;
}

/* A place that gas came from: its cell, and where it is from the cell's centre, in cells. */
struct wall_place {
    int32_t cell;
    float off[3];
};

/* Follows a way back from a cell in steps of half a cell, or less, along one axis after another. It
 * does not go through faces that are shut, but slides along them. Gas in a solid may leave it. */
static struct wall_place wall_trace(const uint8_t *wall, int32_t cell, const float way[3])
{
    enum { STEPS = 2 * GAS_MOST_CELLS };
    struct wall_place p = {cell, {0.0f, 0.0f, 0.0f}};
    for (int k = 0; k < STEPS; k++)
        for (int axis = 0; axis < 3; axis++) {
            const float off = p.off[axis] - way[axis] * (1.0f / STEPS);
            const int32_t to = off > 0.5f ? 1 : off < -0.5f ? -1 : 0;
            if (to && is_shut(wall, p.cell, axis, to) && !(wall[p.cell] & GAS_SOLID))
                continue;
            p.cell += to * WALL_STEP[axis];
            p.off[axis] = off - (float)to;
        }
    return p;
}

/* Says what a value at a place is mixed from. */
struct wall_mix {
    int32_t cell[8]; /* of the block */
    float weight[8];
};

/* Takes the eight cells around a place; for one that is not on its side, that of the place. */
static struct wall_mix wall_mix_at(const uint8_t *wall, struct wall_place p)
{
    struct wall_mix mix;
    const int32_t way[3] = {p.off[0] < 0.0f ? -1 : 1, p.off[1] < 0.0f ? -1 : 1,
                            p.off[2] < 0.0f ? -1 : 1};
    for (int corner = 0; corner < 8; corner++) {
        float weight = 1.0f;
        int32_t taken[3], cell = p.cell;
        for (int axis = 0; axis < 3; axis++) {
            const float part = p.off[axis] < 0.0f ? -p.off[axis] : p.off[axis];
            const bool is_far = corner >> axis & 1;
            weight = weight * (is_far ? part : 1.0f - part);
            taken[axis] = is_far ? way[axis] : 0;
            cell += taken[axis] * WALL_STEP[axis];
        }
        const bool mixes = weight > 0.0f && is_seen(wall, p.cell, taken);
        mix.cell[corner] = mixes ? cell : p.cell;
        mix.weight[corner] = weight;
    }
    return mix;
}

/* Returns what the gas of a brick's cell is mixed from, after its way. */
static struct wall_mix wall_mix_of(const struct gas_workspace *space, int32_t x, int32_t y,
                                   int32_t z)
{
    const float way[3] = {space->way[0][z][y][x], space->way[1][z][y][x], space->way[2][z][y][x]};
    return wall_mix_at(space->wall, wall_trace(space->wall, wall_at(x, y, z), way));
}

/* Returns a cell of a block by its number there. */
static const float *cell_of(const struct rows *rows, int32_t cell)
{
    const int32_t z = cell / WALL_PLANE, y = cell / WALL_ROW % GAS_EDGE;
    const int32_t right = cell % GAS_EDGE - BELOW + GAS_BRICK;
    return rows->of[z * ON + y * UP + right / GAS_BRICK] +
           (ptrdiff_t)(right % GAS_BRICK) * GAS_TRACED;
}

/* Mixes the floats of a cell. */
static void mix_beside_walls(const struct rows *rows, const struct wall_mix *mix, float *to)
{
    struct eight sum = {{{0}}};
    for (int i = 0; i < 8; i++) {
        const struct eight from = eight_load(cell_of(rows, mix->cell[i]));
        EIGHT_EACH(k)
        sum.part[k] = sum.part[k] + mix->weight[i] * from.part[k];
    }
    eight_store(to, sum);
}

#endif
