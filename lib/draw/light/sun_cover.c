/* This file computes how much of the sun spheres, cylinders, capsules and planes hide from a ball;
 * sun_box.h does so for boxes. */
#include "draw/light/sun_box.h"

/* Returns the part of a disc between two parallel lines, whose distances are positive inside. */
static float strip_cover(float one, float other, float radius)
{
    return exact_max(kiln_disc_cover(one / radius) + kiln_disc_cover(other / radius) - 1.0f, 0.0f);
}

float kiln_sphere_sun_cover(float3 center, float radius, struct kiln_ball ball,
                            const struct kiln_sun_frame *sun)
{
    float3 to = float3_sub(center, ball.center);
    float ahead = float3_dot(to, sun->towards);
    float3 across = float3_add_scaled(to, sun->towards, -ahead);
    float square = float3_dot(across, across), away = sqrtf(square);
    float disc = kiln_sun_penumbra(ahead, ball, sun);
    float most = exact_min(radius / disc, 1.0f);
    float cover = strip_cover(radius - away, radius + away, disc) * most;
    return cover * kiln_sun_behind(ahead + sqrtf(exact_max(radius * radius - square, 0.0f)), ball);
}

/* Returns the cover of a cylinder. Its outline is a band along `up`, with round ends. */
float kiln_cylinder_sun_cover(float3 center, float radius, float3 axis, float half_height,
                              struct kiln_ball ball, const struct kiln_sun_frame *sun)
{
    float3 to = float3_sub(center, ball.center);
    float climb = float3_dot(axis, sun->towards);
    float slant = sqrtf(exact_max(1.0f - climb * climb, 1e-6f));
    /* Seen along its axis, the cylinder is round. */
    float3 right =
        slant > 1e-3f ? float3_scale(float3_cross(axis, sun->towards), 1.0f / slant) : sun->right;
    float3 up = float3_cross(sun->towards, right);
    float x = float3_dot(to, right), y = float3_dot(to, up), ahead = float3_dot(to, sun->towards);
    float inside = sqrtf(exact_max(radius * radius - x * x, 0.0f));
    float end = half_height * slant + fabsf(climb) * inside;
    float disc = kiln_sun_penumbra(ahead, ball, sun);
    float cover = strip_cover(radius - fabsf(x), radius + fabsf(x), disc) *
                  strip_cover(end - fabsf(y), end + fabsf(y), disc);
    if (cover <= 0.0f)
        return 0.0f;
    /* The ray at the nearest place inside of the outline leaves the cylinder through its side or
     * its end. */
    float at = exact_clamp(y, -end, end) * (float3_dot(axis, up) < 0.0f ? -1.0f : 1.0f);
    float height = -ahead * climb - at * slant; /* of that place above the middle */
    float beside = -ahead * slant + at * climb; /* away from the axis, on the sun's side */
    float side = (inside - beside) / slant;
    float cap = ((climb < 0.0f ? -half_height : half_height) - height) /
                (climb < 0.0f ? exact_min(climb, -1e-6f) : exact_max(climb, 1e-6f));
    return cover * kiln_sun_behind(exact_min(side, cap), ball);
}

/* Returns the cover of a capsule: that of the nearest to the light's ray of the balls that form the
 * capsule. */
float kiln_capsule_sun_cover(float3 center, float radius, float3 axis, float half_height,
                             struct kiln_ball ball, const struct kiln_sun_frame *sun)
{
    float3 to = float3_sub(center, ball.center);
    float3 flat = float3_add_scaled(axis, sun->towards, -float3_dot(axis, sun->towards));
    float along = -float3_dot(to, flat) / exact_max(float3_dot(flat, flat), 1e-6f);
    float3 nearest = float3_add_scaled(center, axis, exact_clamp(along, -half_height, half_height));
    return kiln_sphere_sun_cover(nearest, radius, ball, sun);
}

float kiln_plane_sun_cover(float3 normal, const struct kiln_sun_frame *sun)
{
    return kiln_disc_cover(-float3_dot(normal, sun->towards) / exact_max(sun->spread, 1e-5f));
}
