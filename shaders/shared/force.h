/* What every force is made of. A force changes a velocity by dv/dt = acceleration - pull * v: what
 * drags is given as a pull, so that the sum of all forces is integrated exactly over a step and no
 * pull, however strong, makes a particle overshoot.
 */
#ifndef KILN_SHARED_FORCE_H
#define KILN_SHARED_FORCE_H

#include "shared/exact.h"
#include "shared/layout.h"

struct force_effect {
    float3 acceleration; /* m/s^2 */
    float pull;          /* 1/s, not negative */
};

/* The options of one force at this time of one particle's life, and where the particle is. */
struct force_input {
    float3 position;
    float time_s;
    float3 vector;
    float strength;
    float3 drift;
    float pull;
    float scale;
    uint octaves;
    uint grid;
    uint seed;
};

/* A pull towards air of a velocity, times the force's strength. */
FN S(force_effect) force_air(S(force_input) f, float3 air)
{
    EXACT float acceleration = f.strength * f.pull;
    EXACT S(force_effect) effect;
    effect.acceleration = float3_scale(air, acceleration);
    effect.pull = f.pull;
    return effect;
}

#endif
