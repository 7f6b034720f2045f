/* How the tables of a scene write their rows, beside what every table writes. Included by
 * options_*.c only. */
#ifndef KILN_SCENE_ROWS_H
#define KILN_SCENE_ROWS_H

#include "option/rows.h"
#include "scene/options.h"
#include "scene/parts.h"

/* The limit of places in a scene: particles beyond 2^20 m die, so this is well inside. */
#define FAR 100000

/* name, field, default, help */
#define BOUNDS(part, n, f, def, h)                                                                 \
    {                                                                                              \
        ROW(part, n, bounds, AT(f), def, h), LIMITS(KILN_METRES, -FAR, FAR), .word = "none"        \
    }

#endif
