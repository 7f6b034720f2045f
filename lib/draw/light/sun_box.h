/* This header computes how much of the sun a box hides from a ball. It has no branches, so that
 * compilers vectorise loops over balls. */
#ifndef KILN_DRAW_LIGHT_SUN_BOX_H
#define KILN_DRAW_LIGHT_SUN_BOX_H

#include "draw/light/sun_cover.h"
#include "draw/moment/sun_outline.h"

struct kiln_sun_box {
    float3 center;
    float4 half_size;
    float size; /* radius of the bounding sphere, m */
    struct sun_edges edges;
};

static inline struct kiln_sun_box kiln_sun_box_at(float3 center, float3 half_size,
                                                  const struct kiln_sun_frame *sun)
{
    return (struct kiln_sun_box){.center = center,
                                 .half_size = {half_size.x, half_size.y, half_size.z, 0.0f},
                                 .size = box_radius(half_size),
                                 .edges = kiln_sun_edges_of(sun->towards)};
}

/* Returns the part of the sun that a box hides from a ball. For a ball beside the box's outline,
 * the way through the box is that at the outline's edge. */
static inline float kiln_sun_box_cover(const struct kiln_sun_box *box, struct kiln_ball ball,
                                       const struct kiln_sun_frame *sun)
{
    bool misses = kiln_sun_cover_is_zero(box->center, box->size, ball, sun);
    const struct ray_slabs slabs = ray_cross_slabs(float3_sub(box->center, ball.center),
                                                   box->half_size, real3_all(box->edges.inverse));
    const struct box_outline outline = box_outline_all(box->edges);
    const struct box_span span = box_span_of(slabs, outline, 1e-3f * box->size);
    float seen = box_cover(slabs, outline, sun->spread, ball.radius) *
                 kiln_sun_inside_factor(span.exit, ball);
    return misses ? 0.0f : seen;
}

#endif
