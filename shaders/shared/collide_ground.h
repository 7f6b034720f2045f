/* Declares what colliders from lattices share: the place where a particle touches them, and the
 * step from cell to cell. */
#ifndef KILN_SHARED_COLLIDE_GROUND_H
#define KILN_SHARED_COLLIDE_GROUND_H

#include "shared/collide_box.h"

/* The number of a surface from a grid, after the faces of other shapes. Terrain's walls are faces
 * 0, 1, 4 and 5, as of a box; the planes of volumes come after this number. */
#define COLLIDE_SURFACE 32u

/* The place where a particle touches a collider that looks up grids. */
struct collide_ground {
    float3 position; /* just outside of the surface */
    float3 normal;   /* interpolated */
    float3 facet;    /* normal of the triangle; no velocity may point against it afterwards */
    float3 velocity; /* m/s, of the surface */
};

/* Returns the part of a path at which it leaves a cell along an axis; 2: it never does. */
FN float collide_leaves(float start, float way, float cell)
{
    EXACT float side = way > 0.0f ? cell + 1.0f : cell;
    EXACT float distance = side - start;
    EXACT float part = exact_div(distance, way);
    EXACT float y = way == 0.0f ? 2.0f : part;
    return y;
}

#endif
