/* Declares the values of shared/sun_cover.h that depend on the directions of the sun and of a shape
 * alone, so that the host computes them once a frame (lib/draw/moment/sun_outline.h). They are
 * members of uniform blocks, so each has the size of a vec4. */
#ifndef KILN_SHARED_SUN_EDGES_H
#define KILN_SHARED_SUN_EDGES_H

#include "shared/platform.h"

/* The outline of a box as seen from the sun: struct box_outline of shared/sun_cover.h. A strip is
 * (first, second, inverse, root). */
struct sun_edges {
    float4 inverse; /* 1 / direction along x, y and z; large where the direction is 0 */
    float4 later;
    float4 xy, yz, xz;
    float4 alike; /* edges along x and y; edges along z and another axis */
};

/* A capped cylinder as seen from the sun: struct cover_band of shared/sun_cover.h. */
struct sun_band {
    float4 right, up;
    float4 lean; /* climb, slant, side */
};

#endif
