/* This header computes how boxes and cylinders look from the sun, in the form of uniform blocks
 * (shared/sun_edges.h), by the formulas of shared/sun_cover.h. */
#ifndef KILN_DRAW_MOMENT_SUN_OUTLINE_H
#define KILN_DRAW_MOMENT_SUN_OUTLINE_H

#include <math.h>

#include "shared/sun_cover.h"

static inline float4 kiln_pack_strip(struct box_strip strip)
{
    return (float4){strip.first, strip.second, strip.inverse, strip.root};
}

/* Returns the outline of a box. towards: unit, to the sun in the box's frame. */
static inline struct sun_edges kiln_sun_edges_of(float3 towards)
{
    const float3 inverse = ray_inverse3(towards);
    const struct box_outline o = box_outline_of(towards, inverse);
    return (struct sun_edges){
        .inverse = {inverse.x, inverse.y, inverse.z, 0.0f},
        .later = {o.later.x, o.later.y, o.later.z, 0.0f},
        .xy = kiln_pack_strip(o.xy),
        .yz = kiln_pack_strip(o.yz),
        .xz = kiln_pack_strip(o.xz),
        .alike = {o.alike_xy, o.alike_z, 0.0f, 0.0f},
    };
}

/* Returns the band of a cylinder. axis: unit; sun: unit, towards it; aside: unit, across it. */
static inline struct sun_band kiln_sun_band_of(float4 axis, float3 sun, float3 aside)
{
    const struct cover_band band = cover_band_of(axis, sun, aside);
    return (struct sun_band){
        .right = {band.right.x, band.right.y, band.right.z, 0.0f},
        .up = {band.up.x, band.up.y, band.up.z, 0.0f},
        .lean = {band.climb, band.slant, band.side, 0.0f},
    };
}

#endif
