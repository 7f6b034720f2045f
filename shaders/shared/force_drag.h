/* Drag towards rest: a speed falls by e every 1 / strength seconds. */
#ifndef KILN_SHARED_FORCE_DRAG_H
#define KILN_SHARED_FORCE_DRAG_H

#include "shared/force.h"

FN S(force_effect) force_drag(S(force_input) f)
{
    EXACT S(force_effect) effect;
    effect.acceleration = FLOAT3(0.0f, 0.0f, 0.0f);
    effect.pull = f.strength;
    return effect;
}

#endif
