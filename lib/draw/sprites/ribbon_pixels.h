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

/* Holds what all pixels of a part of a ribbon share. The first index is 0 for the joint at which it
 * begins and 1 for that at which it ends. */
struct ribbon_strip {
    const struct kiln_sprite *s;
    const struct kiln_ribbon_extra *r;
    float widths, joint_widths[2]; /* of a pixel, in a px across it and along it from the joints */
    float slant[2], beyond[2];     /* how its corners lie: slant * across + beyond, px */
};

/* Returns how many widths of a pixel lie in a px away from a line. */
static inline float widths_a_pixel(const float line[3])
{
    return 1.0f / (fabsf(line[0]) + fabsf(line[1]));
}

SIMD struct ribbon_strip ribbon_strip_of(const struct kiln_sprite *s,
                                         const struct kiln_ribbon_extra *r)
{
    struct ribbon_strip strip = {.s = s, .r = r, .widths = widths_a_pixel(r->middle)};
    for (int i = 0; i < 2; i++) {
        const float *joint = s->joints[i], sign = i == 0 ? 1.0f : -1.0f;
        const float turn = joint[0] * r->middle[1] - joint[1] * r->middle[0];
        strip.joint_widths[i] = widths_a_pixel(joint);
        strip.slant[i] = sign * (joint[0] * r->middle[0] + joint[1] * r->middle[1]);
        strip.beyond[i] = -RIBBON_CORNER * r->half_px[i] * turn;
    }
    return strip;
}

/* Holds what a part of a ribbon is at a vector of pixels. */
struct ribbon_pixels {
    vf along, across; /* places in the cell, 0 to 1 */
    vf part;          /* of the way from the first joint to the second */
    vf depth, cover;
    vi inside;
};

/* Narrows pixels to those that lie on the inner side of a joint. from: their distances from it, px;
 * across: those from the middle line; open: the ribbon goes no farther, and its end is filtered.
 * Elsewhere pixels lie no farther beyond the joint's middle than its corners may. */
SIMD void meet_joint(const struct ribbon_strip *strip, int joint, bool open, vf from, vf across,
                     struct ribbon_pixels *p)
{
    p->inside &= from - strip->slant[joint] * across >= strip->beyond[joint];
    if (open)
        p->cover *= vf_clamp01(from * strip->joint_widths[joint] + 0.5f);
    else
        p->inside &= joint == 0 ? from >= 0.0f : from > 0.0f;
}

SIMD struct ribbon_pixels ribbon_at(const struct ribbon_strip *strip, vf x, vf y)
{
    const struct kiln_sprite *s = strip->s;
    const struct kiln_ribbon_extra *r = strip->r;
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
    p.cover = vf_clamp01((half - vf_abs(across)) * strip->widths + 0.5f);
    p.inside = ~(vi){0};
    meet_joint(strip, 0, (s->flags & KILN_SPRITE_BEGINS) != 0, from, across, &p);
    meet_joint(strip, 1, (s->flags & KILN_SPRITE_ENDS) != 0, to, across, &p);
    p.inside &= p.cover > 0.0f;
    return p;
}

#endif
