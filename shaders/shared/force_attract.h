/* Computes the attraction of particles by a point, or their repulsion if the strength is negative
 * (Drone 2007, 7.5.1). The strength is the acceleration at a distance of 1 m without a radius. The
 * radius softens it at all distances, as in Plummer's sphere, so that no particle is thrown
 * out when it comes very close. */
#ifndef KILN_SHARED_FORCE_ATTRACT_H
#define KILN_SHARED_FORCE_ATTRACT_H

#include "shared/force.h"

/* Returns an acceleration of strength * d * (d^2 + radius^2)^(-n/2), where n is 3, 2, 1 or 0 by the
 * falloff. */
FN S(force_effect) force_attract(S(force_input) f)
{
    EXACT float3 way = float3_sub(f.at.vector, f.position);
    EXACT float square = float3_dot(way, way) + f.at.scale * f.at.scale;
    EXACT float per_metre = exact_rsqrt(square);
    EXACT float per_square = per_metre * per_metre;
    EXACT float factor = per_square * per_metre;
    factor = f.profile == FALLOFF_INVERSE ? per_square : factor;
    factor = f.profile == FALLOFF_CONSTANT ? per_metre : factor;
    factor = f.profile == FALLOFF_LINEAR ? 1.0f : factor;
    factor = factor * f.at.strength;
    EXACT S(force_effect) effect = force_none();
    effect.acceleration = float3_scale(way, factor);
    return effect;
}

#endif
