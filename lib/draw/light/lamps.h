/* This header declares which objects of the backdrop may hide lamps and the light of fire. */
#ifndef KILN_DRAW_LIGHT_LAMPS_H
#define KILN_DRAW_LIGHT_LAMPS_H

#include "draw/moment/shapes.h"
#include "shared/draw_layout.h"

/* Sets, for each light of the block whose `casters` is not 0, the objects that may hide it, and
 * takes from its colour the part that planes and the floor hide. An object that contains the
 * light's centre, such as the glass around a lamp or the hearth around a fire, hides none of it.
 * Boxes, floor and lights of the block must be set. */
void kiln_lamps_find_casters(const struct kiln_draw_shapes *shapes,
                             struct kiln_draw_backdrop *block);

#endif
