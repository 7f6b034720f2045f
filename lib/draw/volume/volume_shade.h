/* Declares what is in the way of the sun and the sky that light gas, beside the smoke of the domain
 * itself: objects, smoke of particles, and the gas of other domains. It is found at every second
 * cell of a block along each axis, and interpolated between. */
#ifndef KILN_DRAW_VOLUME_VOLUME_SHADE_H
#define KILN_DRAW_VOLUME_VOLUME_SHADE_H

#include "draw/light/sun_shade.h"
#include "draw/volume/volume_lamps.h"

/* Holds a grid of smoke_shadow.h. */
struct kiln_volume_smoke {
    const float *depth; /* NULL: there is no smoke */
    const float4 *to_grid;
};

struct kiln_volume_shade {
    struct kiln_sun_shade *objects; /* NULL: there are none, or there is no sun */
    struct kiln_volume_smoke sun, sky;
    enum kiln_simd simd;
};

/* Dims VOLUME_SUN and VOLUME_SCATTERED of a block, and the part of the sky's light in VOLUME_RED,
 * as kiln_volume_light_run has written them. */
void kiln_volume_shade_block(const struct kiln_volume_shade *shade,
                             const struct kiln_volume_frame *frame, struct kiln_gas_place brick,
                             float *block);

/* Holds the parts of light that smoke lets through to places of a block. */
struct kiln_volume_smoke_parts {
    alignas(64) float once[VOLUME_PLACES]; /* of the sun's light that is scattered once */
    alignas(64) float more[VOLUME_PLACES]; /* of that which is scattered several times */
    alignas(64) float sky[VOLUME_PLACES];
};

/* Finds the parts that other smoke than the domain's own lets through. */
typedef void kiln_volume_smoke_reach(const struct kiln_volume_shade *shade,
                                     const struct kiln_volume_frame *frame,
                                     struct kiln_gas_place brick,
                                     struct kiln_volume_smoke_parts *parts);
KILN_SIMD_DECLARE(kiln_volume_smoke_reach, kiln_volume_smoke_reach);

#endif
