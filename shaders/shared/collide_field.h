/* Chooses among the colliders that look up lattices, for shared/collide.h: terrain, and meshes by
 * their distance fields, depth maps, or volumes of planes. */
#ifndef KILN_SHARED_COLLIDE_FIELD_H
#define KILN_SHARED_COLLIDE_FIELD_H

/* Shaders have only the code of the kinds that their scene has. */
#if defined(GL_core_profile) && !defined(COLLIDE_FIELD)
#define COLLIDE_HAS_GRIDS 0
#else
#define COLLIDE_HAS_GRIDS 1
#include "shared/collide_sdf.h"
#endif
#if defined(GL_core_profile) && !defined(COLLIDE_VOLUME)
#define COLLIDE_HAS_VOLUMES 0
#else
#define COLLIDE_HAS_VOLUMES 1
#include "shared/collide_volume.h"
#endif

/* Shaders of scenes without depth maps are compiled without their code. */
#if defined(GL_core_profile) && !defined(COLLIDE_DEPTH)
#define COLLIDE_HAS_DEPTH 0
#else
#define COLLIDE_HAS_DEPTH 1
#include "shared/papers/collide_depth.h"
#endif

/* Returns whether a collider that is neither a volume nor a depth map is terrain, and not a
 * distance field. Shaders of scenes with one of the two kinds have no other code. */
#define COLLIDE_IS_TERRAIN(collider)                                                               \
    (USES(USES_COLLIDERS, COLLIDER_TERRAIN) &&                                                     \
     (!USES(USES_COLLIDERS, COLLIDER_SDF) || (collider).kind == COLLIDER_TERRAIN))

/* Intersects a segment between two parts of the step, as collide_through does. */
FN S(collide_span) collide_field_segment(SIM_PARAM S(kiln_collider) c, float since, float until,
                                         float3 a, float3 b)
{
    EXACT S(collide_span) span;
#if COLLIDE_HAS_VOLUMES
    if (c.kind == COLLIDER_VOLUME) {
        span = volume_segment(SIM c, since, until, a, b);
        return span;
    }
#endif
#if COLLIDE_HAS_DEPTH
    if (c.kind == COLLIDER_DEPTH) {
        span = depth_segment(SIM c, since, until, a, b);
        return span;
    }
#endif
#if COLLIDE_HAS_GRIDS
    if (COLLIDE_IS_TERRAIN(c))
        span = terrain_segment(SIM c, a, b);
    else if (USES(USES_COLLIDERS, COLLIDER_SDF))
        span = sdf_segment(SIM c, since, until, a, b);
#endif
    return span;
}

FN bool collide_field_inside(SIM_PARAM S(kiln_collider) c, float until, float3 p)
{
    bool inside = false;
#if COLLIDE_HAS_VOLUMES
    if (c.kind == COLLIDER_VOLUME) {
        inside = volume_is_inside(SIM c, until, p);
        return inside;
    }
#endif
#if COLLIDE_HAS_DEPTH
    if (c.kind == COLLIDER_DEPTH) {
        inside = depth_is_inside(SIM c, until, p);
        return inside;
    }
#endif
#if COLLIDE_HAS_GRIDS
    if (COLLIDE_IS_TERRAIN(c))
        inside = terrain_is_inside(SIM c, p);
    else if (USES(USES_COLLIDERS, COLLIDER_SDF))
        inside = sdf_is_inside(SIM c, until, p);
#endif
    return inside;
}

FN S(collide_ground) collide_field_ground(SIM_PARAM S(kiln_collider) c, uint face, float since,
                                          float3 p)
{
    EXACT S(collide_ground) ground;
#if COLLIDE_HAS_VOLUMES
    if (c.kind == COLLIDER_VOLUME) {
        ground = volume_ground(SIM c, face, since, p);
        return ground;
    }
#endif
#if COLLIDE_HAS_DEPTH
    if (c.kind == COLLIDER_DEPTH) {
        ground = depth_ground(SIM c, since, p);
        return ground;
    }
#endif
#if COLLIDE_HAS_GRIDS
    if (COLLIDE_IS_TERRAIN(c) && face == COLLIDE_SURFACE)
        ground = terrain_ground(SIM c, p);
    else if (COLLIDE_IS_TERRAIN(c))
        ground = terrain_wall(c, face, p);
    else if (USES(USES_COLLIDERS, COLLIDER_SDF))
        ground = sdf_ground(SIM c, since, p);
#endif
    return ground;
}

/* Returns the box whose top collide_rise moves to: for terrain, the ground at a point; for a
 * volume, nothing, since a particle behind a plane is put in front of it in the next step. */
FN S(collide_box) collide_field_below(SIM_PARAM S(kiln_collider) c, S(collide_box) box, float3 p)
{
    EXACT S(collide_box) below = box;
#if COLLIDE_HAS_VOLUMES
    if (c.kind == COLLIDER_VOLUME)
        below.max.y = p.y;
#endif
#if COLLIDE_HAS_GRIDS
    if (USES(USES_COLLIDERS, COLLIDER_TERRAIN) && c.kind == COLLIDER_TERRAIN) {
        EXACT S(collide_ground) ground = terrain_ground(SIM c, p);
        below.max.y = ground.position.y;
    }
#endif
    return below;
}

/* Returns a velocity relative to a surface, without its part towards the surface. */
FN float3 collide_clear_of(float3 velocity, float3 facet)
{
    EXACT float outwards = float3_dot(velocity, facet);
    EXACT float against = outwards < 0.0f ? -outwards : 0.0f;
    EXACT float3 y = float3_add_scaled(velocity, facet, against);
    return y;
}

#endif
