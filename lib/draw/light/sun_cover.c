/* This file computes how much of the sun spheres, cylinders, capsules and planes hide from a ball;
 * sun_box.h does so for boxes. */
#include "draw/light/sun_box.h"

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

/* Returns the cover of a cylinder. Seen from the sun, its outline is a band along band.up, with
 * round ends. */
float kiln_cylinder_sun_cover(float3 center, float radius, float3 axis, float half_height,
                              struct kiln_ball ball, const struct kiln_sun_frame *sun)
{
    float3 to = float3_sub(center, ball.center);
    const struct cover_band band =
        cover_band_of((float4){axis.x, axis.y, axis.z, half_height}, sun->towards, sun->right);
    const float climb = band.climb, slant = band.slant;
    float x = float3_dot(to, band.right), y = float3_dot(to, band.up);
    float ahead = float3_dot(to, sun->towards);
    float inside = sqrtf(exact_max(radius * radius - x * x, 0.0f));
    float end = half_height * slant + fabsf(climb) * inside;
    float disc = sun_penumbra(ahead, sun->spread, ball.radius);
    float cover = strip_cover(radius - fabsf(x), radius + fabsf(x), disc) *
                  strip_cover(end - fabsf(y), end + fabsf(y), disc);
    if (cover <= 0.0f)
        return 0.0f;
    /* The light's ray, its start moved to the nearest place inside of the outline, leaves the
     * cylinder through its side or its end. */
    float at = exact_clamp(y, -end, end) * band.side;
    float height = -ahead * climb - at * slant; /* of the start above the middle */
    float beside = -ahead * slant + at * climb; /* of the start from the axis, towards the sun */
    float side = (inside - beside) / slant;
    float cap = ((climb < 0.0f ? -half_height : half_height) - height) /
                (climb < 0.0f ? exact_min(climb, -1e-6f) : exact_max(climb, 1e-6f));
    return cover * kiln_sun_inside_factor(exact_min(side, cap), ball);
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
