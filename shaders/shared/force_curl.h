/* Turbulent wind: a pull towards air that moves as curl noise, a field that drifts through space.
 */
#ifndef KILN_SHARED_FORCE_CURL_H
#define KILN_SHARED_FORCE_CURL_H

#include "shared/force.h"
#include "shared/noise.h"

/* Of a particle in the field, whose lattice points lie one unit apart. */
FN float3 force_curl_place(S(force_input) f)
{
    EXACT float3 moved = float3_add_scaled(f.position, f.drift, -f.time_s);
    EXACT float per_metre = exact_rcp(f.scale);
    EXACT float3 place = float3_scale(moved, per_metre);
    return place;
}

FN S(force_effect) force_curl_effect(S(force_input) f, float3 curl)
{
    EXACT float acceleration = f.strength * f.pull;
    EXACT S(force_effect) effect;
    effect.acceleration = float3_scale(curl, acceleration);
    effect.pull = f.pull;
    return effect;
}

FN S(force_effect) force_curl(S(force_input) f)
{
    EXACT float3 place = force_curl_place(f);
    EXACT float3 curl = noise_curl(place, f.seed, f.octaves);
    EXACT S(force_effect) effect = force_curl_effect(f, curl);
    return effect;
}

#endif
