/* This file computes how much of the sun spheres, capsules and planes hide from a ball; sun_box.h
 * and sun_cylinder.h do so for boxes and cylinders. */
#include "draw/light/sun_cover.h"

float kiln_sphere_sun_cover(float3 center, float radius, struct kiln_ball ball,
                            const struct kiln_sun_frame *sun)
{
    float3 to = float3_sub(center, ball.center);
    float ahead = float3_dot(to, sun->towards);
    float3 across = float3_add_scaled(to, sun->towards, -ahead);
    float square = float3_dot(across, across), away = sqrtf(square);
    float disc = sun_penumbra(ahead, sun->spread, ball.radius);
    float most = exact_min(radius / disc, 1.0f);
    float cover = strip_cover(radius - away, radius + away, disc) * most;
    return cover *
           kiln_sun_inside_factor(ahead + sqrtf(exact_max(radius * radius - square, 0.0f)), ball);
}

/* Returns the cover of a capsule: that of one of the balls that form the capsule, the one nearest
 * to the light's ray. */
float kiln_capsule_sun_cover(float3 center, float radius, float3 axis, float half_height,
                             struct kiln_ball ball, const struct kiln_sun_frame *sun)
{
    float3 to = capsule_nearest(float3_sub(center, ball.center),
                                (float4){axis.x, axis.y, axis.z, half_height}, sun->towards);
    return kiln_sphere_sun_cover(float3_add(ball.center, to), radius, ball, sun);
}

float kiln_plane_sun_cover(float3 normal, const struct kiln_sun_frame *sun)
{
    return disc_cover(-float3_dot(normal, sun->towards) / exact_max(sun->spread, 1e-5f));
}
