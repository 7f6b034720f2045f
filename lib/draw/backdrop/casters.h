/* Says where the backdrop's objects are, and which of them may hide lights from what rays hit. A
 * strip of the picture leaves out those that are beside all ways from its surfaces to a light
 * (ray_casters.h). */
#ifndef KILN_DRAW_BACKDROP_CASTERS_H
#define KILN_DRAW_BACKDROP_CASTERS_H

#include <assert.h>

#include "base/bits.h"
#include "draw/backdrop/backdrop_inputs.h"
#include "draw/moment/shape_set.h"

/* A bit for each lamp. */
struct kiln_lamp_set {
    uint32_t words[KILN_BIT_WORDS(KILN_MOST_LAMPS)];
};

static inline bool kiln_lamps_any(const struct kiln_lamp_set *set)
{
    uint32_t any = 0;
    for (uint32_t i = 0; i < KILN_BIT_WORDS(KILN_MOST_LAMPS); i++)
        any |= set->words[i];
    return any != 0;
}

/* Returns the lamps of one set that are not in another. */
static inline struct kiln_lamp_set kiln_lamps_without(const struct kiln_lamp_set *set,
                                                      const struct kiln_lamp_set *others)
{
    struct kiln_lamp_set left;
    for (uint32_t i = 0; i < KILN_BIT_WORDS(KILN_MOST_LAMPS); i++)
        left.words[i] = set->words[i] & ~others->words[i];
    return left;
}

/* Holds what may hide lights. A mesh has a bit. */
struct kiln_casters {
    struct kiln_shape_set lamps[KILN_MOST_LAMPS]; /* by lamp, those of the picture */
    struct kiln_shape_set sun_objects;
    uint64_t sun_meshes;
};

enum {
    KILN_BOUNDS_MESHES = KILN_MAX_OBJECTS, /* the first mesh among the bounds */
    KILN_BOUNDS_ROOM = KILN_MAX_OBJECTS + KILN_MAX_MESHES,
};

static_assert(KILN_MAX_OBJECTS % 16 == 0 && KILN_MAX_MESHES % 16 == 0, "whole vectors of 16");
static_assert(KILN_MAX_MESHES <= 64, "a mesh has a bit of 64");

/* A box around points that get light, m; from > to: there are none. */
struct kiln_lit_box {
    float from[3], to[3];
};

/* Holds boxes along the axes of the world around objects and meshes, m. */
struct kiln_object_bounds {
    float center[3][KILN_BOUNDS_ROOM], half[3][KILN_BOUNDS_ROOM];
};

/* Finds the bounds of all objects, and those that may hide a light from anything. */
void kiln_casters_find(const struct kiln_backdrop_inputs *inputs, struct kiln_object_bounds *bounds,
                       struct kiln_casters *casters);

#endif
