/* Uniform wind: a pull towards the velocity of the air. */
#ifndef KILN_SHARED_FORCE_WIND_H
#define KILN_SHARED_FORCE_WIND_H

#include "shared/exact.h"
#include "shared/force.h"

FN S(force_effect) force_wind(S(force_input) f)
{
    EXACT S(force_effect) effect;
    effect.acceleration = float3_scale(f.vector, f.strength);
    effect.pull = f.strength;
    return effect;
}

#endif
