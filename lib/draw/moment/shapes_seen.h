/* This header declares shapes as seen from the sun, which is in one direction from all points: what
 * the formulas of shared/shapes.h know of them for that direction is computed once a frame. */
#ifndef KILN_DRAW_MOMENT_SHAPES_SEEN_H
#define KILN_DRAW_MOMENT_SHAPES_SEEN_H

#include "shared/shape_layout.h"

/* Holds the numbers of struct KIND_seen of a shape, in the order of its members. */
struct kiln_shape_seen {
    float numbers[24];
};

/* Computes all shapes as seen along a direction. towards: unit, to the light. */
void kiln_shapes_see(const struct kiln_draw_shapes *shapes, float3 towards,
                     struct kiln_shape_seen seen[KILN_MAX_OBJECTS]);

#endif
