/* This header places the points of a block of gas at which the light that reaches it is found. */
#ifndef KILN_DRAW_VOLUME_VOLUME_PLACES_H
#define KILN_DRAW_VOLUME_VOLUME_PLACES_H

#include "base/real.h"
#include "draw/volume/volume_lamps.h"

/* Returns places of a block from number `first` on, m. */
SIMD struct vf3 volume_places_of(const struct kiln_volume_frame *frame, struct kiln_gas_place brick,
                                 int first)
{
    float at[3][LANES], place[3];
    for (int i = 0; i < LANES; i++) {
        kiln_volume_find_place(frame, brick, first + i, place);
        for (int c = 0; c < 3; c++)
            at[c][i] = place[c];
    }
    return (struct vf3){vf_load(at[0]), vf_load(at[1]), vf_load(at[2])};
}

#endif
