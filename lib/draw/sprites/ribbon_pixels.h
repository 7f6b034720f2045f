/* This header finds which pixels a part of a ribbon covers, and which places of it they show. Two
 * neighbours share the line on which they meet, and decide by the same bits on which side of it a
 * pixel lies: no pixel is left out, and none is drawn twice. */
#ifndef KILN_DRAW_SPRITES_RIBBON_PIXELS_H
#define KILN_DRAW_SPRITES_RIBBON_PIXELS_H

#include <math.h>

#include "base/lane_math.h"
#include "draw/sprites/sprite.h"
#include "shared/ribbon_layout.h"

/* Returns the distances of pixels from a line, px: the same bits for each sprite that has the line.
 */
SIMD vf distance_from(const float line[3], vf x, vf y)
{
    return line[0] * x + (line[1] * y + line[2]);
}

/* Returns what of a pixel's width a distance of 1 px from a line is. */
static inline float widths_a_pixel(const float line[3])
{
    return 1.0f / (fabsf(line[0]) + fabsf(line[1]));
}

/* Returns whether pixels lie no farther beyond a joint's middle, along the ribbon, than its corners
 * may. from: their distances from the joint, px; across: those from the middle line. */
SIMD vi are_near_joint(const float joint[3], const float middle[3], float half, vf from, vf across,
                       float sign)
{
    const float turn = joint[0] * middle[1] - joint[1] * middle[0];
    const float slant = joint[0] * middle[0] + joint[1] * middle[1];
    return from - sign * slant * across >= -RIBBON_CORNER * half * turn;
}

/* Holds what a part of a ribbon is at a vector of pixels. */
struct ribbon_pixels {
    vf along, across; /* places in the cell, 0 to 1 */
    vf part;          /* of the way from the first joint to the second */
    vf depth, cover;
    vi inside;
};

SIMD struct ribbon_pixels ribbon_at(const struct kiln_sprite *s, const struct kiln_ribbon_extra *r,
                                    vf x, vf y)
{
    const vf zero = vf_all(0.0f);
    const vf from = distance_from(s->joints[0], x, y), to = -distance_from(s->joints[1], x, y);
    const vf across = distance_from(r->middle, x, y);
    const vf past = vf_max(from, zero), left = vf_max(to, zero);
    const vf seen = past / vf_max(past + left, vf_all(1e-6f)); /* part of the way in the picture */
    const vf near = r->near[0] + (r->near[1] - r->near[0]) * seen;
    const vf half = r->half_px[0] + (r->half_px[1] - r->half_px[0]) * seen;
    struct ribbon_pixels p;
    p.depth = 1.0f / near;
    p.part = seen * r->near[1] * p.depth;
    p.along = r->along[0] + (r->along[1] - r->along[0]) * p.part;
    if (s->flags & KILN_SPRITE_REPEATS)
        p.along -= vf_floor(p.along);
    p.across = 0.5f + 0.5f * across / half;
    p.cover = vf_clamp01((half - vf_abs(across)) * widths_a_pixel(r->middle) + 0.5f);
    p.inside = are_near_joint(s->joints[0], r->middle, r->half_px[0], from, across, 1.0f) &
               are_near_joint(s->joints[1], r->middle, r->half_px[1], to, across, -1.0f);
    if (s->flags & KILN_SPRITE_BEGINS)
        p.cover *= vf_clamp01(from * widths_a_pixel(s->joints[0]) + 0.5f);
    else
        p.inside &= from >= 0.0f;
    if (s->flags & KILN_SPRITE_ENDS)
        p.cover *= vf_clamp01(to * widths_a_pixel(s->joints[1]) + 0.5f);
    else
        p.inside &= to > 0.0f;
    p.inside &= p.cover > 0.0f;
    return p;
}

#endif
