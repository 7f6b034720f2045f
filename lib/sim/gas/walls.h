/* Traces gas beside solids: its way ends at a face that is shut, and a value is mixed from the
 * cells on its own side alone (Guendelman et al., "Coupling Water and Smoke to Thin Deformable and
 * Rigid Shells", 2005). Only advect_simd.c includes this header. It works cell by cell, since few
 * bricks have solids. */
#ifndef KILN_SIM_GAS_WALLS_H
#define KILN_SIM_GAS_WALLS_H

#include "sim/gas/block.h"

enum { WALL_ROW = GAS_EDGE, WALL_PLANE = GAS_EDGE * GAS_EDGE };

static const int32_t WALL_STEP[3] = {1, WALL_ROW, WALL_PLANE};
static const uint8_t WALL_SHUT[3] = {GAS_SHUT_X, GAS_SHUT_Y, GAS_SHUT_Z};

/* Fills the bits of a block's cells. There are no solids beyond the window. */
static void gather_walls(const struct gas_pass *pass, const struct around *around,
                         gas_brick_place at, struct gas_workspace *space)
{
    const struct kiln_gas_place count = pass->gas->bricks;
    uint8_t *to = space->wall;
    for (int32_t z = 0; z < GAS_EDGE; z++)
        for (int32_t y = 0; y < GAS_EDGE; y++)
            for (int32_t x = 0; x < GAS_EDGE; x++, to++) {
                const struct kiln_gas_place b = {at.x + around->x.brick[x] - 1,
                                                 at.y + around->y.brick[y] - 1,
                                                 at.z + around->z.brick[z] - 1};
                const struct gas_wall *wall =
                    b.x < count.x && b.y < count.y && b.z < count.z
                        ? pass->walls[kiln_gas_brick_index(pass->gas, b.x, b.y, b.z)]
                        : NULL;
                const int32_t cell =
                    (around->z.cell[z] * GAS_BRICK + around->y.cell[y]) * GAS_BRICK +
                    around->x.cell[x];
                *to = wall ? wall->cell[cell] : 0;
            }
}

/* Returns the place of a brick's cell in its block. */
static int32_t wall_at(int32_t x, int32_t y, int32_t z)
{
    return (z + BELOW) * WALL_PLANE + (y + BELOW) * WALL_ROW + x + BELOW;
}

/* Returns whether gas of a cell may come from or go to cells whose faces are shut. */
static bool is_near_wall(const uint8_t *wall, int32_t x, int32_t y, int32_t z)
{
    const int32_t at = wall_at(x, y, z) - BELOW * (WALL_PLANE + WALL_ROW + 1);
    for (int32_t k = 0; k < 2 * BELOW + 2; k++)
        for (int32_t j = 0; j < 2 * BELOW + 2; j++)
            for (int32_t i = 0; i < 2 * BELOW + 2; i++) {
                const int32_t cell = at + k * WALL_PLANE + j * WALL_ROW + i;
                if (z + k < GAS_EDGE && y + j < GAS_EDGE && x + i < GAS_EDGE && wall[cell])
                    return true;
            }
    return false;
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

/* Mixes floats of the cells around a place that are on its side. `floats` a cell of `width`. */
static void wall_mix(const uint8_t *wall, const float *floats, int width, struct wall_place p,
                     float *to)
{
    const float *own = floats + (ptrdiff_t)p.cell * width;
    float sum[GAS_TRACED] = {0};
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
        const float *from = mixes ? floats + (ptrdiff_t)cell * width : own;
        for (int i = 0; i < width; i++)
            sum[i] = sum[i] + weight * from[i];
    }
    memcpy(to, sum, (size_t)width * sizeof *sum);
}

#endif
