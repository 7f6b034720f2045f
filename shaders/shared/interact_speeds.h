/* Computes bounds of velocities as maxima of integers, which are the same in any order: of x and of
 * -x, then of y and z. Without particles, they are 0. */
#ifndef KILN_SHARED_INTERACT_SPEEDS_H
#define KILN_SHARED_INTERACT_SPEEDS_H

#include "shared/exact.h"

#define SPEEDS_BOUNDS 6u

/* Maps a number to an integer above 0 of the same order; NaN is the largest. */
FN uint speeds_key(float x)
{
    uint bits = FLOAT_BITS(x);
    bool below = (bits & EXACT_SIGN_BIT) != 0u;
    return below ? ~bits : bits | EXACT_SIGN_BIT;
}

FN float speeds_value(uint key)
{
    bool below = (key & EXACT_SIGN_BIT) == 0u;
    return BITS_FLOAT(below ? ~key : key & ~EXACT_SIGN_BIT);
}

/* Returns bound number `bound` of one velocity. */
FN uint speeds_bound(float3 velocity, uint bound)
{
    uint axis = bound >> 1u;
    EXACT float along = velocity.z;
    if (axis < 2u)
        along = axis == 0u ? velocity.x : velocity.y;
    EXACT float backwards = -along;
    return speeds_key((bound & 1u) == 0u ? along : backwards);
}

#endif
