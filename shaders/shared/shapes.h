/* Declares the drawing of shapes. A new kind is a file shape_KIND.h with these functions, and a row
 * of shape_kinds.h:
 *   KIND_cross       where a ray is inside of the shape
 *   KIND_face        the surface that it enters by at t
 *   KIND_seen_along  what the next two functions must know of the shape for a direction
 *   KIND_cover       what it hides of a light; the result counts in the lanes of a mask
 *   KIND_may_hide    whether it may hide any: a closer test than that of its bounding sphere
 *   KIND_is_smooth   whether its shadow on a block of a surface is blurred over the block, which is
 *                    lit as a ball of its size is
 *   KIND_sky         the part of the sky that a surface sees beside it
 *   KIND_size        radius of the bounding sphere around its centre, m
 *   KIND_contains    whether it contains a place, which is `from` its centre
 *   KIND_reach       how far it extends from its centre along a unit vector, m
 * A shader that defines KILN_SHAPES itself has only the kinds that its scene has. */
#ifndef KILN_SHARED_SHAPES_H
#define KILN_SHARED_SHAPES_H

#include "shared/shape.h"
#include "shared/shape_kinds.h"

#ifndef KILN_SHAPES
#define KILN_SHAPES(ROW) SHAPE_KINDS_OF_DRAWING(ROW)
#endif

#endif
