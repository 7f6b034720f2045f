/* Lists the kinds of shapes. A new one is a file shape_KIND.h with these functions, and a row here:
 *   KIND_cross     where a ray is inside of the shape
 *   KIND_face      the surface that it enters by at t
 *   KIND_seen_along  struct KIND_seen: what the next two functions must know of it for a direction
 *   KIND_cover     what the shape hides of a light; its result counts in the lanes of a mask
 *   KIND_may_hide  whether it may hide any: a test before KIND_cover, by more than its bounding
 *                  sphere
 *   KIND_is_smooth whether its shadow is blurred over a block of a surface, which is lit as a ball
 *                  of its size is
 *   KIND_sky       the part of the sky that a surface sees beside it
 *   KIND_size      radius of the bounding sphere around its centre, m
 *   KIND_contains  whether it contains a place, which is `from` its centre
 *   KIND_reach     how far it extends from its centre along a unit vector, m
 * A shader that defines KILN_SHAPES itself has only the kinds that its scene has. */
#ifndef KILN_SHARED_SHAPES_H
#define KILN_SHARED_SHAPES_H

#include "shared/shape.h"

/* All kinds have the same parameters, of which some use only a part. */
#ifndef GL_core_profile
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

#include "shared/shape_box.h"
#include "shared/shape_capsule.h"
#include "shared/shape_cylinder.h"
#include "shared/shape_plane.h"

#ifndef GL_core_profile
#pragma GCC diagnostic pop
#endif

#ifndef KILN_SHAPES
#define KILN_SHAPES(ROW)                                                                           \
    ROW(BOX, box) ROW(CYLINDER, cylinder) ROW(CAPSULE, capsule) ROW(PLANE, plane)
#endif

#endif
