/* Says which objects may hide lights from what rays hit, and where these objects are. A strip of
 * the picture leaves out those that are beside all ways from its surfaces to a light
 * (ray_casters.h). */
#ifndef KILN_DRAW_BACKDROP_CASTERS_H
#define KILN_DRAW_BACKDROP_CASTERS_H

#include <assert.h>

#include "draw/backdrop/backdrop_inputs.h"

/* Objects have a bit each, in the order of kiln_draw_light.casters.x, and so have meshes. */
struct kiln_casters {
    uint32_t lamps[KILN_MAX_LIGHTS + KILN_MAX_FIRE_LIGHTS]; /* by lamp: objects */
    uint32_t sun_objects, sun_meshes;
};

enum {
    KILN_CASTER_MESHES = KILN_MAX_OBJECTS, /* the first mesh among the bounds */
    KILN_CASTER_ROOM = 48,                 /* whole vectors */
};

static_assert(KILN_MAX_OBJECTS + KILN_MAX_MESHES <= KILN_CASTER_ROOM, "all casters have room");

/* Holds boxes along the axes of the world around objects and meshes, m. */
struct kiln_caster_bounds {
    float center[3][KILN_CASTER_ROOM], half[3][KILN_CASTER_ROOM];
};

/* Finds the bounds of all objects, and those that may hide a light from anything. */
void kiln_casters_find(const struct kiln_backdrop_inputs *inputs, struct kiln_caster_bounds *bounds,
                       struct kiln_casters *casters);

#endif
