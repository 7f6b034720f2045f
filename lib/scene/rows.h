/* Defines macros by which the tables of a scene write their rows, in addition to those of
 * option/rows.h. Only options_*.c include it.
 *
 * A row says which part of a scene its key belongs to (scene/parts.h):
 *   MOTION  the key changes how particles move, so states that were saved with another value of it
 *           are not used; unit.motion checks that it does
 *   LOOK    the key changes pictures alone
 *   VIEW    the key changes where the camera sees particles, or at which moments
 * A row says how its number may vary (option/rows.h):
 *   TIME    it is a constant or a curve over the time of the clip
 *   BOTH    it may also be a curve over the life of a particle
 *   0       it is a constant
 */
#ifndef KILN_SCENE_ROWS_H
#define KILN_SCENE_ROWS_H

#include "option/rows.h"
#include "scene/options.h"
#include "scene/parts.h"

/* The largest coordinate in a scene, in metres; -FAR is the smallest. Particles beyond 2^20 m die,
 * so it is well below that. */
#define FAR 100000

/* name, field, default, help */
#define BOUNDS(part, n, f, def, h)                                                                 \
    {                                                                                              \
        ROW(part, n, bounds, f, def, h), LIMITS(KILN_METRES, -FAR, FAR), .special_word = "none"    \
    }

#endif
