/* This header declares the shade of blocks of particles from the sun and from lamps
 * (shade_simd.c). */
#ifndef KILN_DRAW_LIGHT_SHADE_BLOCKS_H
#define KILN_DRAW_LIGHT_SHADE_BLOCKS_H

#include "draw/light/lamp_shade.h"
#include "draw/moment/appearance_blocks.h"

/* Writes the part of the sun that each particle sees past shapes: 0 to 1, and 1 where no particle
 * lives. casters: kiln_shapes_that_hide. */
typedef void
kiln_sun_shade_block(const struct kiln_draw_shapes *shapes, const struct kiln_shape_set *casters,
                     const struct kiln_shape_seen *from_sun, const struct kiln_sun_frame *sun,
                     const struct kiln_appearance_block *block, float visible[KILN_LANES]);
KILN_SIMD_DECLARE(kiln_sun_shade_block, kiln_sun_shade_block);

/* Writes the word of each lane for four lights. casters: of each light, the shapes that may hide
 * it; count: how many lights there are. */
typedef void kiln_lamp_shade_block(const struct kiln_lamp_objects *objects,
                                   const struct kiln_draw_light *lights,
                                   const struct kiln_shape_set *casters, uint32_t count,
                                   const struct kiln_appearance_block *block,
                                   uint32_t words[KILN_LANES]);
KILN_SIMD_DECLARE(kiln_lamp_shade_block, kiln_lamp_shade_block);

#endif
