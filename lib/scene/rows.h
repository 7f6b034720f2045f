/* Defines macros by which the tables of a scene write their rows, in addition to those of
 * option/rows.h. Only options_*.c include it.
 *
 * A row says which part of a scene its key belongs to (scene/parts.h):
 *   MOTION  the key changes how particles move, so states that were saved with another value of it
 *           are not used; unit.motion checks that it does
 *   LOOK    the key changes pictures alone
 *   OF_NODE the key changes what is attached to the node
 *   VIEW    the key changes where the camera sees particles, or at which moments
 * A row says how its value may vary (option/rows.h), with a number of its own:
 *   TIME      it is the same for all particles of a system at a time
 *   BIRTH     a particle gets it at its birth; it may also be random
 *   LIFE      a particle has it at a moment; every clock but the distance to the eye is known
 *   DRAWN     a particle has it when it is drawn; every clock is known
 *   SUMMED    it is summed up over a particle's life
 *   0         it does not vary
 * Random values and noise depend on the number, so it must not change. It is below 256; tables of
 * systems have numbers of their own, and tables outside of systems others, of which none is used
 * twice (unit.draws).
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

/* The node that a part of the scene lies in: part, help */
#define ATTACH(part, h)                                                                            \
    {                                                                                              \
        ROW(part, "attach", attach, attach, "none", h), .special_word = "none"                     \
    }

/* The members of a struct kiln_animation, each of which has `of` before its name: part, of */
#define ANIMATION(part, of)                                                                        \
    {ROW(part, "clip", clip, of clip, "0",                                                         \
         "Name of the animation in the file, or its number from 0.")},                             \
        VALUE(part, "start", of start, KILN_SECONDS, -FAR, FAR, 0, "0 s",                          \
              "Time in the animation at clip time 0."),                                            \
        VALUE(part, "speed", of speed, KILN_PLAIN, -1000, 1000, 0, "1",                            \
              "Factor on the speed of the animation; a value below 0 plays it backwards."),        \
        BOOLEAN(part, "loop", of loop, "true",                                                     \
                "The animation starts again at its end. Otherwise it stays at its last pose.")

#endif
