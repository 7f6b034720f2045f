/* This header declares functions for the part of the sun that convex shapes hide from a ball, on
 * top of shared/sun_cover.h. */
#ifndef KILN_DRAW_LIGHT_SUN_COVER_H
#define KILN_DRAW_LIGHT_SUN_COVER_H

#include <math.h>

#include "draw/moment/shapes.h"
#include "shared/exact.h"
#include "shared/sun_cover.h"

struct kiln_ball {
    float3 center;
    float radius; /* m */
};

/* Returns true if a shape surely hides nothing from a ball. size: radius of the shape's bounding
 * sphere about its centre, m. */
static inline bool kiln_sun_cover_is_zero(float3 center, float size, struct kiln_ball ball,
                                          const struct kiln_sun_frame *sun)
{
    float3 to = float3_sub(center, ball.center);
    float ahead = float3_dot(to, sun->towards);
    float3 across = float3_add_scaled(to, sun->towards, -ahead);
    float away = sqrtf(float3_dot(across, across));
    float reach = size + sun_penumbra(ahead + size, sun->spread, ball.radius);
    return (ahead < -size) | (away > reach);
}

/* Returns the factor by which a shape's cover counts for a ball that is partly inside the shape.
 * exit_distance: from the ball's centre towards the sun until it leaves the shape, m. The factor is
 * 1 at a distance of the ball's radius or more, and falls to 0 with it. */
static inline float kiln_sun_inside_factor(float exit_distance, struct kiln_ball ball)
{
    return exact_clamp(exit_distance / exact_max(ball.radius, 1e-4f), 0.0f, 1.0f);
}

/* Return the part of the sun that a shape hides from a ball, 0 to 1. Inside of the shape, this part
 * falls to 0 within a ball's radius of the side towards the sun. */
float kiln_sphere_sun_cover(float3 center, float radius, struct kiln_ball ball,
                            const struct kiln_sun_frame *sun);
float kiln_capsule_sun_cover(float3 center, float radius, float3 axis, float half_height,
                             struct kiln_ball ball, const struct kiln_sun_frame *sun);

/* Returns the part of the sun that the half space below a plane hides from any place above it, 0 to
 * 1. */
float kiln_plane_sun_cover(float3 normal, const struct kiln_sun_frame *sun);

#endif
