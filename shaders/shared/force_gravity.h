/* Computes a constant acceleration: gravity, or the lift of hot air. */
#ifndef KILN_SHARED_FORCE_GRAVITY_H
#define KILN_SHARED_FORCE_GRAVITY_H

#include "shared/force.h"

FN S(force_effect) force_gravity(S(force_input) f)
{
    EXACT S(force_effect) effect = force_none();
    effect.acceleration = f.at.vector;
    return effect;
}

#endif
