/* Declares what C and GLSL share of the profiles of gas (lib/draw/volume/volume_profile.h): their
 * numbers, how a place in one is found, and how shaders reach them. */
#ifndef KILN_SHARED_GAS_PROFILE_H
#define KILN_SHARED_GAS_PROFILE_H

#include "shared/exact.h"

#define VOLUME_PACKET 8  /* pixels whose rays march together */
#define VOLUME_TILE   8  /* pixels along an edge of a tile */
#define VOLUME_NODES  32 /* most places of a ray */

/* Words of the head of a profile, and the unit of places in the memory of profiles. */
#define VOLUME_PROFILE_WORDS 16

#define VOLUME_DEPTH_UNIT (1.0f / 8192.0f)

/* The optical depth of gas that is half opaque: the natural logarithm of 2. */
#define VOLUME_HALF_OPAQUE 0.693147181f

/* Gas that lets less than this part of the light through hides all that is behind it. */
#define VOLUME_OPAQUE_BELOW 0.002f

/* The numbers that pixels without a profile of their own have in its place. */
#define VOLUME_NO_PROFILE 0 /* no gas is seen there */
/* The gas of the pixel is the mean of that of its neighbours with a ray: the pixels of the 2, or 4,
 * nearest even columns and rows. */
#define VOLUME_BETWEEN 1

/* Shaders read the profiles from a buffer texture of 16 bytes a texel; for each domain it has the
 * nearest depth of each tile, the profile of each pixel, and the memory of its profiles, which has
 * four texels for the head of a profile, four for each 16 of its places, and one for the numbers of
 * a pixel at a place. */
#define KILN_BIND_GAS      4 /* the uniform block */
#define KILN_UNIT_PROFILES 21

/* The gas that particles of a pass are blended with (struct kiln_tile_gas). */
struct kiln_gas_before_block {
    uint4 picture;  /* width and height of the gas's picture, px; tiles of a row; domains */
    float4 place;   /* pixels of that picture along an edge of a pixel; margins, px of it; unused */
    float4 covered; /* the light of smoke, of flames, and their glow that particles cover: 0, 1 */
    uint4 domains[4]; /* texels at which depths, profiles of pixels and memory begin; unused */
    float4 blooms;    /* of each domain: the part of the light of flames that glows */
};

/* Returns a pixel of the gas's picture, which has `count` of them along this edge, at a place. */
FN uint profile_pixel(float place, uint count)
{
    EXACT float last = FLOAT(count - 1u);
    EXACT float held = place < 0.0f ? 0.0f : place < last ? place : last;
    return exact_uint(held);
}

/* Returns the part of the way from a place of a profile to the next one. */
FN float profile_part(float place, float from, float next)
{
    EXACT float way = (place - from) / (next - from);
    EXACT float part = way < 0.0f ? 0.0f : way < 1.0f ? way : 1.0f;
    return part;
}

#endif
