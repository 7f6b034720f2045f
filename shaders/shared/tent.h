/* The tent filter that reduces a picture by any ratio, compiled as C and as GLSL. A pixel of the
 * smaller picture is a tent over the pixels of the larger one, which reaches to the centres of its
 * neighbours. Neighbouring tents overlap, so a spark that crosses from one pixel to the next does
 * not jump. Tents are integrated over each pixel of the larger picture, so all weights of a smaller
 * pixel sum to 1, and those of a larger pixel to 1 / ratio, whatever the ratio is: a filter of
 * sampled tents would make a ripple.
 */
#ifndef KILN_SHARED_TENT_H
#define KILN_SHARED_TENT_H

#include "shared/exact.h"

/* Returns the part below x of a tent that reaches from -1 to 1 and has an area of 1. */
FN float tent_below(float x)
{
    EXACT float limited = exact_clamp(x, -1.0f, 1.0f);
    EXACT float rest = 1.0f - exact_abs(limited);
    EXACT float outside = 0.5f * rest * rest;
    return limited < 0.0f ? outside : 1.0f - outside;
}

/* Returns the place of the centre of pixel `reduced` of the smaller picture among the pixels of the
 * larger one, where 0 is the centre of pixel 0. ratio: pixels of the larger picture for one of the
 * smaller, at least 1. */
FN float tent_center(float reduced, float ratio)
{
    EXACT float center = (reduced + 0.5f) * ratio - 0.5f;
    return center;
}

/* Returns the weight of a pixel at a distance from such a centre, in pixels of the larger picture.
 * It is 0 beyond ratio + 1/2. */
FN float tent_weight(float distance, float ratio)
{
    EXACT float high = tent_below((distance + 0.5f) / ratio);
    EXACT float low = tent_below((distance - 0.5f) / ratio);
    EXACT float weight = high - low;
    return weight;
}

#endif
