/* Computes the keys by which particles are sorted, with the same bits in C and in GLSL, so that
 * every technique of the sort gives the same list. */
#ifndef KILN_SHARED_KEYS_H
#define KILN_SHARED_KEYS_H

#include "shared/exact.h"
#include "shared/particle.h"

/* Returns a key that ascends while the depth descends: the float's order as unsigned integers,
 * reversed. */
FN uint key_of_depth(float depth_m)
{
    EXACT float canonical = exact_canon(depth_m);
    uint bits = FLOAT_BITS(canonical);
    return (bits & EXACT_SIGN_BIT) != 0u ? bits : ~(bits | EXACT_SIGN_BIT);
}

/* Returns the key of a particle seen from an eye in a direction of unit length; the farthest has
 * the least key. No record holds a NaN, so none gets here. */
FN uint key_of_particle(S(kiln_particle) p, float3 eye, float3 forward)
{
    EXACT float3 position = particle_position(p);
    EXACT float3 from_eye = float3_sub(position, eye);
    EXACT float depth_m = float3_dot(from_eye, forward);
    return key_of_depth(depth_m);
}

#endif
