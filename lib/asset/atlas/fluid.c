/* This file initialises a fluid: all at rest, with each sample at its own place. */
#include "asset/atlas/fluid.h"

#include <string.h>

void kiln_fluid_init(struct kiln_fluid *fluid)
{
    memset(fluid, 0, sizeof *fluid);
    for (uint32_t i = 0; i < KILN_FLUID_SIZE; i++) {
        fluid->place_x[i] = kiln_fluid_at(i % KILN_FLUID_EDGE);
        fluid->place_y[i] = kiln_fluid_at(i / KILN_FLUID_EDGE);
    }
}
