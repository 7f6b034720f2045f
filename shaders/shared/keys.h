/* What particles are ordered by: the same bits in C and in GLSL, so that every technique of the
 * sort gives the same list.
 */
#ifndef KILN_SHARED_KEYS_H
#define KILN_SHARED_KEYS_H

#include "shared/exact.h"
#include "shared/particle.h"

/* Ascending for descending depth: the order of floats as unsigned integers, turned round. */
FN uint key_of_depth(float depth_m)
{
    EXACT float canonical = exact_canon(depth_m);
    uint bits = FLOAT_BITS(canonical);
    return (bits & EXACT_SIGN_BIT) != 0u ? bits : ~(bits | EXACT_SIGN_BIT);
}

/* The key of a particle seen from an eye in a direction of unit length: the farthest has the
 * least. No record holds a NaN, so no key comes from one. */
FN uint key_of_particle(S(kiln_particle) p, float3 eye, float3 forward)
{
    EXACT float3 position = particle_position(p);
    EXACT float3 from_eye = float3_sub(position, eye);
    EXACT float depth_m = float3_dot(from_eye, forward);
    return key_of_depth(depth_m);
}

#endif
