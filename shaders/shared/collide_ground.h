/* What colliders out of lattices have in common: where a particle touches them, and the way from
 * cell to cell.
 */
#ifndef KILN_SHARED_COLLIDE_GROUND_H
#define KILN_SHARED_COLLIDE_GROUND_H

#include "shared/collide_box.h"

/* The face of a surface out of a grid, after those of other shapes; terrain's walls are 0, 1, 4
 * and 5, as a box's, and the planes of volumes come after it. */
#define COLLIDE_SURFACE 32u

/* Where a particle touches a collider that looks up grids. */
struct collide_ground {
    float3 position; /* just outside of the surface */
    float3 normal;   /* interpolated */
    float3 facet;    /* that of the surface itself: nothing goes against it */
    float3 velocity; /* m/s, of the surface */
};

/* The part of a path at which it leaves a cell along an axis; 2: it never does. */
FN float collide_leaves(float start, float way, float cell)
{
    EXACT float side = way > 0.0f ? cell + 1.0f : cell;
    EXACT float distance = side - start;
    EXACT float part = exact_div(distance, way);
    EXACT float y = way == 0.0f ? 2.0f : part;
    return y;
}

#endif
