/* The light that falls on a sprite. */
#ifndef KILN_DRAW_SPRITE_LIGHT_H
#define KILN_DRAW_SPRITE_LIGHT_H

#include "draw/sprite.h"

/* Light from everywhere, and how it changes along the billboard's axes (right, up, towards the
 * viewer): spherical harmonics of degrees 0 and 1, for each colour. */
struct kiln_sprite_light {
    float parts[4][3];
};

/* The billboard's axes in the world. */
struct kiln_sprite_axes {
    float3 right, up, normal;
};

/* Of the particle in a slot. lit: how much of the light is reflected; the rest of a sprite is as
 * bright as if in white light. */
struct kiln_sprite_light kiln_sprite_light(const struct kiln_sprite_pass *pass, uint32_t slot,
                                           float lit, const struct kiln_sprite_axes *axes,
                                           float3 position);

#endif
