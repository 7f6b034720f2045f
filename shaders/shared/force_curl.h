/* Turbulent wind: a pull towards air that moves as curl noise, a field that drifts through space.
 */
#ifndef KILN_SHARED_FORCE_CURL_H
#define KILN_SHARED_FORCE_CURL_H

#include "shared/force.h"
#include "shared/noise.h"

FN S(force_effect) force_curl(S(force_input) f)
{
    EXACT float3 moved = float3_add_scaled(f.position, f.drift, -f.time_s);
    EXACT float per_metre = exact_rcp(f.scale);
    EXACT float3 place = float3_scale(moved, per_metre);
    EXACT float3 curl = noise_curl(place, f.seed, f.octaves);
    EXACT float acceleration = f.strength * f.pull;
    EXACT S(force_effect) effect;
    effect.acceleration = float3_scale(curl, acceleration);
    effect.pull = f.pull;
    return effect;
}

#endif
