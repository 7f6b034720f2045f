/* This header declares the lamps of a scene at a moment, and which objects may hide lights. */
#ifndef KILN_DRAW_LIGHT_LAMPS_H
#define KILN_DRAW_LIGHT_LAMPS_H

#include "draw/moment/moment.h"
#include "shared/draw_layout.h"

/* Fills in the scene's lamps, whose `casters.x` and `.w` are 1 for those that objects and smoke
 * hide, and 0 for others. Returns how many there are. */
uint32_t kiln_lamps_fill(const struct kiln_moment *moment, struct kiln_draw_light *lights);

/* Sets, for each light whose `casters` is not 0, the objects that may hide it, meshes left out, and
 * takes from its colour the part that planes and the floor hide. An object that contains the
 * light's centre, such as the glass around a lamp or the hearth around a fire, hides none of it. */
void kiln_lamps_find_casters(const struct kiln_moment *moment, struct kiln_draw_light *lights,
                             uint32_t count);

/* Holds the objects of the backdrop that may hide lights, and maps of what else does. */
struct kiln_lamp_objects {
    const struct kiln_draw_shapes *shapes;
    const uint32_t *maps;       /* of kiln_lamp_maps_run */
    const uint32_t *solid_maps; /* of kiln_lamp_solids_run */
};

#endif
