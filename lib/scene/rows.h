/* Defines macros by which the tables of a scene write their rows, in addition to those of
 * option/rows.h. Only options_*.c include it. */
#ifndef KILN_SCENE_ROWS_H
#define KILN_SCENE_ROWS_H

#include "option/rows.h"
#include "scene/options.h"
#include "scene/parts.h"

/* The limit of coordinates in a scene. Particles beyond 2^20 m die, so it is well below that. */
#define FAR 100000

/* name, field, default, help */
#define BOUNDS(part, n, f, def, h)                                                                 \
    {                                                                                              \
        ROW(part, n, bounds, AT(f), def, h), LIMITS(KILN_METRES, -FAR, FAR),                       \
            .special_word = "none"                                                                 \
    }

#endif
