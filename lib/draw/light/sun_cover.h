/* This header declares how much of the sun convex shapes hide from a ball, as
 * shaders/draw/light/sun_cover.glsl computes it for a point; the ball's radius is added to that of
 * the penumbra. */
#ifndef KILN_DRAW_LIGHT_SUN_COVER_H
#define KILN_DRAW_LIGHT_SUN_COVER_H

#include <math.h>

#include "draw/moment/shapes.h"
#include "shared/exact.h"

struct kiln_ball {
    float3 center;
    float radius; /* m */
};

/* Returns the width of a shadow's edge on a ball that is behind a shape at a distance, m. */
static inline float kiln_sun_penumbra(float along, struct kiln_ball ball,
                                      const struct kiln_sun_frame *sun)
{
    float wide = exact_max(along, 0.0f) * sun->spread + ball.radius;
    return exact_max(wide, 1e-5f);
}

/* Returns whether a shape within a sphere of a size about its centre can hide nothing from a
 * ball. */
static inline bool kiln_sun_misses(float3 center, float size, struct kiln_ball ball,
                                   const struct kiln_sun_frame *sun)
{
    float3 to = float3_sub(center, ball.center);
    float ahead = float3_dot(to, sun->towards);
    float3 across = float3_add_scaled(to, sun->towards, -ahead);
    float away = sqrtf(float3_dot(across, across));
    float reach = size + kiln_sun_penumbra(ahead + size, ball, sun);
    return (ahead < -size) | (away > reach);
}

/* Return the cover, 0 to 1. A shape hides the sun from a ball behind it and, up to the ball's
 * radius, inside of it. */
float kiln_sphere_sun_cover(float3 center, float radius, struct kiln_ball ball,
                            const struct kiln_sun_frame *sun);
float kiln_cylinder_sun_cover(float3 center, float radius, float3 axis, float half_height,
                              struct kiln_ball ball, const struct kiln_sun_frame *sun);
float kiln_capsule_sun_cover(float3 center, float radius, float3 axis, float half_height,
                             struct kiln_ball ball, const struct kiln_sun_frame *sun);

/* Returns the cover of the half space below a plane, for any place above: 0 to 1. */
float kiln_plane_sun_cover(float3 normal, const struct kiln_sun_frame *sun);

#endif
