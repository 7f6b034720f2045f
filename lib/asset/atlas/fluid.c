/* This file sets the fluid that carries the gas of a procedural flipbook to its starting state: the
 * velocity and all other fields are 0, and each sample's start place is the sample's own. film.c
 * calls it once for each flipbook; fluid_simd.c moves the fluid from there. */
#include "asset/atlas/fluid.h"

#include <string.h>

void kiln_fluid_init(struct kiln_fluid *fluid)
{
    memset(fluid, 0, sizeof *fluid);
    for (uint32_t i = 0; i < KILN_FLUID_SIZE; i++) {
        fluid->place_x[i] = kiln_fluid_coordinate(i % KILN_FLUID_EDGE);
        fluid->place_y[i] = kiln_fluid_coordinate(i / KILN_FLUID_EDGE);
    }
}
