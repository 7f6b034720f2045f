/* Drag towards rest: a speed falls by e every 1 / strength seconds; what grows with the square of
 * the speed halves it every 1 / (quadratic * speed) seconds. */
#ifndef KILN_SHARED_FORCE_DRAG_H
#define KILN_SHARED_FORCE_DRAG_H

#include "shared/force.h"

FN S(force_effect) force_drag(S(force_input) f)
{
    EXACT S(force_effect) effect = force_none();
    effect.pull = f.strength;
    effect.quadratic = f.pull;
    return effect;
}

#endif
