/* This header computes how much boxes hide of a light from vectors of points, as lamp_box_cover and
 * box_cover do, but skips what no lane of a vector needs. Most boxes that are near the way to a
 * light hide nothing of it from a whole vector: the points lie on the box, or the box is behind the
 * light. The bits are those of the shared functions. */
#ifndef KILN_DRAW_LIGHT_RAY_BOX_H
#define KILN_DRAW_LIGHT_RAY_BOX_H

#include "base/real.h"
#include "shared/lamp_cover.h"

/* Returns what box_strip_cover does in the lanes of a mask. Where each of these lanes is beyond the
 * penumbras of both edges, the cover is 0 or 1 and needs no division. */
SIMD vf ray_strip_cover(struct box_edges edges, vi near, vf spread, vf radius)
{
    const vi blurred = (vf_abs(edges.one) < sun_penumbra(edges.one_at, spread, radius)) |
                       (vf_abs(edges.other) < sun_penumbra(edges.other_at, spread, radius));
    if (any(near & blurred))
        return box_strip_cover(edges, spread, radius);
    return vf_where((edges.one > 0.0f) & (edges.other > 0.0f), vf_all(1.0f));
}

/* Returns what box_cover does in the lanes of a mask; 0 in other lanes. */
SIMD vf ray_box_cover(const struct ray_slabs *s, const struct box_outline *o, vi near, vf spread,
                      vf radius)
{
    const vf none = vf_all(0.0f);
    const vf yz = ray_strip_cover(box_edges_yz(*s, *o), near, spread, radius);
    near &= yz != 0.0f;
    if (!any(near))
        return none;
    const vf xz = ray_strip_cover(box_edges_xz(*s, *o), near, spread, radius);
    near &= xz != 0.0f;
    if (!any(near))
        return none;
    const vf xy = ray_strip_cover(box_edges_xy(*s, *o), near, spread, radius);
    return vf_where(near, both_strips(both_strips(yz, xz, o->alike_xy), xy, o->alike_z));
}

/* Returns the part of a lamp that a box hides in the lanes of a mask; 0 elsewhere. s: where the
 * ways to the lamp cross the box's slabs. */
SIMD vf ray_lamp_box_cover(const struct ray_slabs *s, const struct box_outline *o, vi near,
                           const struct lamp_way *way)
{
    const struct box_span span = box_span_of(*s, *o, LAMP_BOX_EDGE);
    const vf side = cover_side(span.exit, way->lit), part = lamp_part_beyond(*way, span.enter);
    near &= side * part != 0.0f;
    if (!any(near))
        return vf_all(0.0f);
    return ray_box_cover(s, o, near, way->spread, way->lit) * side * part;
}

#endif
