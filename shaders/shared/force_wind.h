/* Computes uniform wind: a pull towards air of one velocity, `vector`. */
#ifndef KILN_SHARED_FORCE_WIND_H
#define KILN_SHARED_FORCE_WIND_H

#include "shared/exact.h"
#include "shared/force.h"

FN S(force_effect) force_wind(S(force_input) f)
{
    EXACT float per_s = f.at.pull + f.added;
    EXACT S(force_effect) effect = force_none();
    effect.acceleration = float3_scale(f.at.vector, per_s);
    effect.pull = f.at.pull;
    return effect;
}

#endif
