/* This header computes how much of the sun a cylinder hides from a ball. It has no branches, so
 * that compilers vectorise loops over balls. */
#ifndef KILN_DRAW_LIGHT_SUN_CYLINDER_H
#define KILN_DRAW_LIGHT_SUN_CYLINDER_H

#include "draw/light/sun_cover.h"

/* A cylinder, and how it looks from the sun: a band along band.up, with round ends. */
struct kiln_sun_cylinder {
    float3 center;
    float radius, half_height; /* m */
    float size;                /* radius of the bounding sphere, m */
    struct cover_band band;
    float top;   /* m: the height above the middle of the end that light leaves through */
    float climb; /* band.climb, not 0 */
};

/* axis: unit. */
static inline struct kiln_sun_cylinder kiln_sun_cylinder_at(float3 center, float radius,
                                                            float3 axis, float half_height,
                                                            const struct kiln_sun_frame *sun)
{
    const float4 height = {axis.x, axis.y, axis.z, half_height};
    const struct cover_band band = cover_band_of(height, sun->towards, sun->right);
    const bool falls = band.climb < 0.0f;
    return (struct kiln_sun_cylinder){
        .center = center,
        .radius = radius,
        .half_height = half_height,
        .size = sqrtf(radius * radius + half_height * half_height),
        .band = band,
        .top = falls ? -half_height : half_height,
        .climb = falls ? exact_min(band.climb, -1e-6f) : exact_max(band.climb, 1e-6f),
    };
}

/* Returns the part of the sun that a cylinder hides from a ball. */
static inline float kiln_sun_cylinder_cover(const struct kiln_sun_cylinder *c,
                                            struct kiln_ball ball, const struct kiln_sun_frame *sun)
{
    const float climb = c->band.climb, slant = c->band.slant;
    float3 to = float3_sub(c->center, ball.center);
    float x = float3_dot(to, c->band.right), y = float3_dot(to, c->band.up);
    float ahead = float3_dot(to, sun->towards);
    float inside = sqrtf(exact_max(c->radius * c->radius - x * x, 0.0f));
    float end = c->half_height * slant + exact_abs(climb) * inside;
    float disc = sun_penumbra(ahead, sun->spread, ball.radius);
    float cover = strip_cover(c->radius - exact_abs(x), c->radius + exact_abs(x), disc) *
                  strip_cover(end - exact_abs(y), end + exact_abs(y), disc);
    /* The light's ray, its start moved to the nearest place inside of the outline, leaves the
     * cylinder through its side or its end. */
    float at = exact_clamp(y, -end, end) * c->band.side;
    float height = -ahead * climb - at * slant; /* of the start above the middle */
    float beside = -ahead * slant + at * climb; /* of the start from the axis, towards the sun */
    float side = (inside - beside) / slant;
    float cap = (c->top - height) / c->climb;
    bool misses = kiln_sun_cover_is_zero(c->center, c->size, ball, sun);
    float seen = cover * kiln_sun_inside_factor(exact_min(side, cap), ball);
    return misses ? 0.0f : seen;
}

#endif
