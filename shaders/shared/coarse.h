/* Decides, for GLSL and for C, which pixels of a coarse picture of particles belong to a place of
 * the frame, by the depths of the scene. Both languages agree to rounding. Depths are view-space
 * metres, and the sky is far away. */
#ifndef KILN_SHARED_COARSE_H
#define KILN_SHARED_COARSE_H

#include "shared/exact.h"

/* COARSE_SIMILAR: relative difference of two depths at which the weight is one half.
 * COARSE_NONPLANAR: relative second difference of reciprocal depths above which there is an edge.
 * COARSE_REMOTE, 1/m: smaller differences of reciprocal depths are far away and do not count.
 * COARSE_APART: weight of places that are not neighbours. */
#define COARSE_SIMILAR   0.03f
#define COARSE_NONPLANAR 0.04f
#define COARSE_REMOTE    0.001f
#define COARSE_APART     0.001f

/* Returns whether three depths in a row do not lie on a plane. On a plane, the reciprocal depth is
 * linear in the picture: 1/a - 2/b + 1/c, times all of them, is 0. */
FN bool coarse_is_nonplanar(float a, float b, float c)
{
    EXACT float bc = b * c, ac = a * c, ab = a * b;
    EXACT float leap = exact_abs(bc - 2.0f * ac + ab);
    EXACT float larger = exact_max(bc, ac);
    EXACT float limit = COARSE_NONPLANAR * exact_max(larger, ab) + COARSE_REMOTE * (ab * c);
    return leap > limit;
}

/* Returns the weight of a coarse pixel by its distance along one axis, in coarse pixels. */
FN float coarse_near(float away)
{
    EXACT float near = 1.0f - exact_abs(away);
    EXACT float weight = exact_max(near, COARSE_APART);
    return weight;
}

/* Returns the weights of four pixels in a row at a place between the middle two, a fraction t after
 * the first of these. It is the cubic spline of Catmull and Rom, which is sharper than linear
 * interpolation. */
FN float4 coarse_spline(float t)
{
    EXACT float t2 = t * t, t3 = t2 * t;
    EXACT float before = -0.5f * t3 + t2 - 0.5f * t;
    EXACT float low = 1.5f * t3 - 2.5f * t2 + 1.0f;
    EXACT float high = -1.5f * t3 + 2.0f * t2 + 0.5f * t;
    EXACT float after = 0.5f * t3 - 0.5f * t2;
    EXACT float4 weights = FLOAT4(before, low, high, after);
    return weights;
}

/* Returns the weight of a depth by its similarity to another. */
FN float coarse_similarity(float depth, float other)
{
    EXACT float between = exact_abs(depth - other), least = exact_min(depth, other);
    EXACT float away = exact_min(between / (COARSE_SIMILAR * least), 1e4f);
    EXACT float away2 = away * away;
    EXACT float weight = 1.0f / (1.0f + away2 * away2);
    return weight;
}

#endif
