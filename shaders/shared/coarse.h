/* How particles of a coarse picture are told apart by the depth of the scene: for GLSL and for C,
 * which agree to rounding. Depths are view-space metres, the sky far away.
 */
#ifndef KILN_SHARED_COARSE_H
#define KILN_SHARED_COARSE_H

#include "shared/exact.h"

#define COARSE_ALIKE  0.03f  /* part of a depth by which another may differ to count half */
#define COARSE_BENT   0.04f  /* part of a reciprocal depth that a plane's does not leap */
#define COARSE_REMOTE 0.001f /* 1/m: leaps of less are far off */
#define COARSE_APART  0.001f /* weight of places that are not neighbours */

/* Whether three depths in a row are not those of a plane, whose reciprocal depth is linear in the
 * picture: 1/a - 2/b + 1/c, times all of them. */
FN bool coarse_is_bent(float a, float b, float c)
{
    EXACT float bc = b * c, ac = a * c, ab = a * b;
    EXACT float leap = exact_abs(bc - 2.0f * ac + ab);
    EXACT float larger = exact_max(bc, ac);
    EXACT float limit = COARSE_BENT * exact_max(larger, ab) + COARSE_REMOTE * (ab * c);
    return leap > limit;
}

/* Weight of a coarse pixel so many of its widths away, along one axis. */
FN float coarse_near(float away)
{
    EXACT float near = 1.0f - exact_abs(away);
    EXACT float weight = exact_max(near, COARSE_APART);
    return weight;
}

/* Weights of four pixels in a row for a place between the middle two, t on the way from the one to
 * the other: the cubic spline of Catmull and Rom, which is sharper than a straight line. */
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

/* Weight of one depth for another. */
FN float coarse_alike(float depth, float other)
{
    EXACT float between = exact_abs(depth - other), least = exact_min(depth, other);
    EXACT float away = exact_min(between / (COARSE_ALIKE * least), 1e4f);
    EXACT float away2 = away * away;
    EXACT float weight = 1.0f / (1.0f + away2 * away2);
    return weight;
}

#endif
