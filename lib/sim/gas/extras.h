/* Moves along what cells carry beside: the colour of smoke, and ways from where gas was. It is
 * traced back alone, without the correction that the rest has. Only advect_simd.c includes this
 * header. */
#ifndef KILN_SIM_GAS_EXTRAS_H
#define KILN_SIM_GAS_EXTRAS_H

#include "sim/gas/places.h"
#include "sim/gas/walls.h"

/* Brings together a group of a block's extra floats. Beyond open sides there are none. */
static void gather_extras(const struct around *around, struct gas_workspace *space, uint32_t group)
{
    static const float none[GAS_CARRIED];
    float *to = space->extras;
    for (int32_t z = 0; z < GAS_EDGE; z++)
        for (int32_t y = 0; y < GAS_EDGE; y++)
            for (int32_t x = 0; x < GAS_EDGE; x++, to += GAS_CARRIED) {
                const struct kiln_gas_brick *brick =
                    around->brick[around->z.brick[z]][around->y.brick[y]][around->x.brick[x]];
                const ptrdiff_t cell =
                    gas_row_of_brick(around->y.cell[y], around->z.cell[z]) + around->x.cell[x];
                const bool open = around->x.open[x] || around->y.open[y] || around->z.open[z];
                copy_four(to, open || !brick->extras
                                  ? none
                                  : brick->extras +
                                        ((ptrdiff_t)group * GAS_BRICK_CELLS + cell) * GAS_CARRIED);
            }
}

#define MIX(a, b, part) ((a) + ((b) - (a)) * (part))

/* Interpolates a group of extra floats between the eight cells around a place. */
SIMD void mix_extras(const float *extras, const struct places *places, int i, float *to)
{
    const int32_t cell = places->row[i] / 3 * GAS_EDGE + (places->row[i] % 3 - 1) * GAS_BRICK +
                         places->at[i] / GAS_TRACED + BELOW;
    const float *at = extras + (ptrdiff_t)cell * GAS_CARRIED;
    const float x = places->x[i], y = places->y[i], z = places->z[i];
    enum { ABOVE = GAS_EDGE * GAS_CARRIED, BEHIND = GAS_EDGE * ABOVE };
    for (int c = 0; c < GAS_CARRIED; c++) {
        const float *p = at + c, *q = p + BEHIND;
        const float near =
            MIX(MIX(p[0], p[GAS_CARRIED], x), MIX(p[ABOVE], p[ABOVE + GAS_CARRIED], x), y);
        const float far =
            MIX(MIX(q[0], q[GAS_CARRIED], x), MIX(q[ABOVE], q[ABOVE + GAS_CARRIED], x), y);
        to[c] = MIX(near, far, z);
    }
}

/* Mixes a group of extra floats from the cells on a place's side of a wall. */
static void mix_extras_beside_walls(const float *extras, const struct wall_mix *mix, float *to)
{
    float sum[GAS_CARRIED] = {0};
    for (int i = 0; i < 8; i++)
        for (int c = 0; c < GAS_CARRIED; c++)
            sum[c] = sum[c] + mix->weight[i] * extras[(ptrdiff_t)mix->cell[i] * GAS_CARRIED + c];
    memcpy(to, sum, sizeof sum);
}

/* Traces the extra floats of a brick. Cells that remember where their gas came from add their own
 * way. */
static void trace_extras(const struct gas_pass *pass, const struct around *around,
                         struct kiln_gas_brick *brick, struct gas_workspace *space)
{
    const struct kiln_gas_shape *shape = &pass->gas->shape;
    const float cell = pass->step->cell;
    for (uint32_t group = 0; group < kiln_gas_groups(shape); group++) {
        const bool is_way = shape->detailed && group >= kiln_gas_group(shape, GAS_CAME_FROM);
        gather_extras(around, space, group);
        float *to = brick->next_extras + (size_t)group * GAS_BRICK_CELLS * GAS_CARRIED;
        for (int32_t z = 0; z < GAS_BRICK; z++)
            for (int32_t y = 0; y < GAS_BRICK; y++) {
                struct places places;
                places_from(&places, space, y, z);
                for (int x = 0; x < GAS_BRICK; x++, to += GAS_CARRIED) {
                    if (around->walls && is_near_wall(space, x, y, z)) {
                        const struct wall_mix mix = wall_mix_of(space, x, y, z);
                        mix_extras_beside_walls(space->extras, &mix, to);
                    } else {
                        mix_extras(space->extras, &places, x, to);
                    }
                    for (int c = 0; c < 3 && is_way; c++)
                        to[c] = to[c] + space->way[c][z][y][x] * cell;
                }
            }
    }
}

#endif
