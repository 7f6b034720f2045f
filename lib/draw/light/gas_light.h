/* This header declares the light of burning gas on what is around it: the emission of its flames,
 * gathered into a few moving point lights. */
#ifndef KILN_DRAW_LIGHT_GAS_LIGHT_H
#define KILN_DRAW_LIGHT_GAS_LIGHT_H

#include "draw/light/gas_cells.h"

/* Gathers the lights of a block and returns their number, at most KILN_GAS_LIGHTS. Smoke does not
 * dim them: what gas swallows of its own light is taken from them already. 0 if nothing burns, or
 * if the block has no glow. */
uint32_t kiln_gas_light_gather(const struct kiln_gas_block *block, struct kiln_threads *threads,
                               struct kiln_draw_light *lights);

#endif
