/* Computes turbulent wind: a pull towards air that moves as curl noise, a field that drifts through
 * space. */
#ifndef KILN_SHARED_FORCE_CURL_H
#define KILN_SHARED_FORCE_CURL_H

#include "shared/force.h"
#include "shared/noise.h"

/* Returns a particle's place in the field, whose lattice points lie one unit apart. */
FN float3 force_curl_place(S(force_input) f)
{
    EXACT float3 moved = float3_add_scaled(f.position, f.at.second, -f.time_s);
    EXACT float per_metre = exact_rcp(f.at.scale);
    EXACT float3 place = float3_scale(moved, per_metre);
    return place;
}

FN S(force_effect) force_curl(S(force_input) f)
{
    EXACT float3 place = force_curl_place(f);
    EXACT float3 curl = noise_curl(place, f.seed, f.octaves);
    EXACT S(force_effect) effect = force_air(f, curl);
    return effect;
}

#endif
