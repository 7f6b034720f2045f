/* Finds the places that gas comes from and goes to in a step, and interpolates there. Only
 * advect_simd.c and the headers that it includes use this one. */
#ifndef KILN_SIM_GAS_PLACES_H
#define KILN_SIM_GAS_PLACES_H

#include "sim/gas/block.h"

/* Interpolates between the eight cells around a point. row: the table's entry of the lowest of
 * their rows; x: place of the first cell in it. Points to parts of the way: 0 to 1. */
SIMD struct eight mixed(const float *const *row, int32_t x, const float *part_x,
                        const float *part_y, const float *part_z)
{
    struct eight result;
    const vf across = vf_all(*part_x), up = vf_all(*part_y), along = vf_all(*part_z);
    const float *a = row[0] + x, *b = row[UP] + x, *c = row[ON] + x, *d = row[ON + UP] + x;
    EIGHT_EACH(k)
    {
        const int o = k * LANES;
#define PAIR(q) gas_mix(vf_load((q) + o), vf_load((q) + o + GAS_TRACED), across)
        result.part[k] =
            gas_mix(gas_mix(PAIR(a), PAIR(b), up), gas_mix(PAIR(c), PAIR(d), up), along);
    }
    return result;
}

/* Holds points in a block: the entry of the lowest of the eight cells around each in a table of
 * rows, its place in the row, and the parts of the way to the highest. */
struct places {
    _Alignas(32) int32_t row[GAS_BRICK], at[GAS_BRICK];
    _Alignas(32) float x[GAS_BRICK], y[GAS_BRICK], z[GAS_BRICK];
};

/* Finds the places of points. x, y, z: in cells from the brick's first; lane: the first of the row.
 */
SIMD void places_of(struct places *places, int lane, vf x, vf y, vf z)
{
    const vf whole_x = round_down(x), whole_y = round_down(y), whole_z = round_down(z);
    vf_store(places->x + lane, x - whole_x);
    vf_store(places->y + lane, y - whole_y);
    vf_store(places->z + lane, z - whole_z);
    const vi right = vi_of(whole_x) + GAS_BRICK;
    const vi row =
        vi_of(whole_z * (float)ON + whole_y * (float)UP) + BELOW * (ON + UP) + (right >> 3);
    const vi at = (right & (GAS_BRICK - 1)) * GAS_TRACED;
    memcpy(places->row + lane, &row, sizeof row);
    memcpy(places->at + lane, &at, sizeof at);
}

/* Finds the places that a row of a brick's cells came from. */
SIMD void places_from(struct places *places, const struct gas_workspace *space, int32_t y,
                      int32_t z)
{
    for (int lane = 0; lane < GAS_BRICK; lane += LANES)
        places_of(places, lane, vf_count() + (float)lane - vf_load(&space->way[0][z][y][lane]),
                  (float)y - vf_load(&space->way[1][z][y][lane]),
                  (float)z - vf_load(&space->way[2][z][y][lane]));
}

/* Finds those that it goes to. scale: of velocities to cells a step. */
SIMD void places_to(struct places *places, const struct gas_workspace *space, float scale,
                    int32_t y, int32_t z)
{
    for (int lane = 0; lane < GAS_BRICK; lane += LANES) {
        vf way[3];
        for (int c = 0; c < 3; c++)
            way[c] = gas_way_forth(
                vf_load(&space->velocity[c][z + BELOW][y + BELOW][lane + BELOW]) * scale,
                vf_load(&space->way[c][z][y][lane]));
        places_of(places, lane, vf_count() + (float)lane + way[0], (float)y + way[1],
                  (float)z + way[2]);
    }
}

#endif
