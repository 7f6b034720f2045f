/* This header places the points of a block of gas at which the light that reaches it is found. */
#ifndef KILN_DRAW_VOLUME_VOLUME_PLACES_H
#define KILN_DRAW_VOLUME_VOLUME_PLACES_H

#include "base/real.h"
#include "draw/volume/volume_lamps.h"

/* Returns places of a block from number `first` on, m. */
SIMD struct vf3 volume_places_of(const struct kiln_volume_frame *frame, struct kiln_gas_place brick,
                                 int first)
{
    const int count = VOLUME_SPARSE * VOLUME_SPARSE * VOLUME_SPARSE;
    float at[3][LANES];
    for (int i = 0; i < LANES; i++) {
        const int n = first + i < count ? first + i : count - 1;
        const float cell[3] = {
            (float)(brick.x * GAS_BRICK + 2 * (n % VOLUME_SPARSE)) + 0.5f,
            (float)(brick.y * GAS_BRICK + 2 * (n / VOLUME_SPARSE % VOLUME_SPARSE)) + 0.5f,
            (float)(brick.z * GAS_BRICK + 2 * (n / (VOLUME_SPARSE * VOLUME_SPARSE))) + 0.5f};
        for (int c = 0; c < 3; c++)
            at[c][i] = frame->corner[c] + frame->edges[0][c] * cell[0] +
                       frame->edges[1][c] * cell[1] + frame->edges[2][c] * cell[2];
    }
    return (struct vf3){vf_load(at[0]), vf_load(at[1]), vf_load(at[2])};
}

#endif
