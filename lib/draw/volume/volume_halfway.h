/* This header finds where the gas of eight rays becomes half opaque (kiln_volume_halfway). The gas
 * of a step is even, so the place within a step has a closed form. */
#ifndef KILN_DRAW_VOLUME_VOLUME_HALFWAY_H
#define KILN_DRAW_VOLUME_VOLUME_HALFWAY_H

#include "draw/volume/volume_packet.h"

/* Holds the gas of rays that a step adds. */
struct halfway_step {
    struct eight before, behind; /* optical depth of this domain before and behind it */
    struct eight middle, length; /* of the step, cells */
};

SIMD_ONCE void halfway_begin(const struct kiln_volume_march *m, const struct pixels *pixels,
                             struct halfway *h)
{
    float depth[VOLUME_PACKET] = {0};
    for (uint32_t k = 0; k < pixels->count; k++)
        depth[k] = VOLUME_HALF_OPAQUE - m->halfway.passed[pixels->at[k]];
    *h = (struct halfway){.depth = eight_load(depth)};
}

/* Returns whether a ray becomes half opaque between two optical depths. Most steps have none. */
SIMD bool halfway_lies_in(const struct eight *before, const struct eight *behind,
                          const struct halfway *h)
{
    vi some = vi_all(0);
    EIGHT_EACH(k)
    some |= (before->part[k] < h->depth.part[k]) & (h->depth.part[k] <= behind->part[k]);
    return any(some);
}

SIMD_ONCE void halfway_add(const struct halfway_step *step, struct halfway *h)
{
    EIGHT_EACH(k)
    {
        const vf from = step->before.part[k], to = step->behind.part[k], half = h->depth.part[k];
        const vf part = (half - from) / vf_max(to - from, vf_all(1e-20f));
        const vf place = step->middle.part[k] + step->length.part[k] * (part - 0.5f);
        h->place.part[k] = vf_select((from < half) & (half <= to), place, h->place.part[k]);
    }
}

/* Stores the depths of the pixels, and adds the optical depth of this domain. a_metre: cells along
 * rays for a metre of depth. */
SIMD_ONCE void halfway_store(const struct kiln_volume_march *m, const struct halfway *h,
                             struct eight a_metre, struct eight depth, const struct pixels *pixels)
{
    _Alignas(32) float place[8], metre[8], passed[8];
    eight_store(place, h->place);
    eight_store(metre, a_metre);
    eight_store(passed, depth);
    for (uint32_t k = 0; k < pixels->count; k++) {
        const size_t at = pixels->at[k];
        if (place[k] > 0.0f)
            m->halfway.depth_m[at] = place[k] / metre[k];
        m->halfway.passed[at] += passed[k];
    }
}

/* Rays between which a pixel's depth is the mean of theirs are at most so far apart, cells. */
#define HALFWAY_CELLS 2.0f

/* Sets the depth of a pixel without a ray to the mean of those of its neighbours, if the march asks
 * for it. Returns false if these are too far apart, so that the pixel needs a ray. */
SIMD bool halfway_between(const struct kiln_volume_march *m, uint32_t x, uint32_t y)
{
    const uint32_t across = x % 2, down = y % 2;
    if (!m->halfway.depth_m)
        return true;
    float least = 1e9f, most = 0.0f, sum = 0.0f, count = 0.0f;
    for (uint32_t row = y - down; row <= y + down; row += 2)
        for (uint32_t column = x - across; column <= x + across; column += 2) {
            const float depth = m->halfway.depth_m[(size_t)row * m->width + column];
            least = depth < least ? depth : least;
            most = depth > most ? depth : most;
            sum += depth;
            count += 1.0f;
        }
    if (most - least > HALFWAY_CELLS * m->cell_m)
        return false;
    if (least < 1e9f)
        m->halfway.depth_m[(size_t)y * m->width + x] = sum / count;
    return true;
}

#endif
