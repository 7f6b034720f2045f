/* Computes drag towards rest. A linear drag reduces a speed by the factor e every 1 / pull seconds.
 * A quadratic drag halves it in 1 / (quadratic * speed) seconds. */
#ifndef KILN_SHARED_FORCE_DRAG_H
#define KILN_SHARED_FORCE_DRAG_H

#include "shared/force.h"

FN S(force_effect) force_drag(S(force_input) f)
{
    EXACT S(force_effect) effect = force_none();
    effect.pull = f.at.pull;
#ifdef FORCES_ALL
    effect.quadratic = f.at.quadratic;
#endif
    return effect;
}

#endif
