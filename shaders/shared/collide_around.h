/* Colliders by their numbers, as balls meet them.
 */
#ifndef KILN_SHARED_COLLIDE_AROUND_H
#define KILN_SHARED_COLLIDE_AROUND_H

#include "shared/layout.h"

FN float4 collide_shifted(float4 v, float by)
{
    EXACT float4 y = FLOAT4(v.x + by, v.y + by, v.z + by, v.w);
    return y;
}

/* The same of one that looks up a grid: its bounds, and the radius for whoever looks up. The walls
 * of terrain and depth maps are met with the centre. */
FN S(kiln_collider) collide_field_around(S(kiln_collider) collider, float radius)
{
    EXACT S(kiln_collider) c = collider;
    EXACT float raised = radius * c.steepest;
    if (c.kind == COLLIDER_TERRAIN) {
        c.max.y = c.max.y + raised;
        c.max_end.y = c.max_end.y + raised;
        c.center.w = radius;
    } else if (c.kind == COLLIDER_SDF) { /* its grid is as much wider */
        c.center.w = radius;
    }
    return c;
}

/* A collider as a ball of a radius meets it with its centre: as much larger as the ball is. Edges
 * and corners stay sharp. Shaders of scenes without interaction are spared this. */
FN S(kiln_collider) collide_around(SIM_PARAM uint number, float radius)
{
    EXACT S(kiln_collider) c = AROUND(colliders[number]);
#if !defined(GL_core_profile) || defined(PUSHES)
    if (radius > 0.0f && c.kind >= COLLIDER_TERRAIN) {
        c = collide_field_around(c, radius);
    } else if (radius > 0.0f) {
        EXACT float lower = -radius;
        c.min = collide_shifted(c.min, lower);
        c.min_end = collide_shifted(c.min_end, lower);
        c.max = collide_shifted(c.max, radius);
        c.max_end = collide_shifted(c.max_end, radius);
        c.center.w = c.center.w + radius;
        c.center_end.w = c.center_end.w + radius;
        if (c.kind == COLLIDER_CYLINDER) {
            c.axis.w = c.axis.w + radius;
            c.half_height_end = c.half_height_end + radius;
        }
        if (c.kind != COLLIDER_CAPSULE) { /* it grows by its radius alone */
            c.extent = collide_shifted(c.extent, radius);
            c.extent_end = collide_shifted(c.extent_end, radius);
        }
    }
#endif
    return c;
}

#endif
