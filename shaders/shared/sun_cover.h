/* Computes how much of the sun convex shapes hide from a point: penumbras without samples. At the
 * distance of an edge, the light from the sun to the point passes through a disc. The cover is the
 * part of this disc beyond the edge, 0 to 1. For a ball that is lit, the disc's radius grows by the
 * ball's. */
#ifndef KILN_SHARED_SUN_COVER_H
#define KILN_SHARED_SUN_COVER_H

#include "shared/shape_rays.h"
#include "shared/sun_edges.h"

/* ---- edges ----------------------------------------------------------------------------------- */

/* Returns the part of a disc on the far side of a line, by the line's signed distance from the
 * centre in radii: a cubic within 1.5 % of the exact circle segment. */
REAL_FN real disc_cover(real distance)
{
    real x = real_clamp01(0.5f + 0.5f * distance);
    return x * x * (3.0f - 2.0f * x);
}

/* Returns the part of a disc between two parallel lines, whose distances are positive inside. */
REAL_FN real strip_cover(real one, real other, real radius)
{
    real scale = 1.0f / real_max(radius, real_all(1e-5f));
    return real_max(disc_cover(one * scale) + disc_cover(other * scale) - 1.0f, real_all(0.0f));
}

/* Returns the radius of the disc at a distance along the ray, m. spread: the tangent of the angle
 * of the sun's radius; radius: of the ball that is lit, m. */
REAL_FN real sun_penumbra(real along, float spread, float radius)
{
    return real_max(along * spread + radius, real_all(exact_max(radius, 1e-5f)));
}

/* ---- boxes ----------------------------------------------------------------------------------- */

struct sun_crossed {
    real cover;
    real outside; /* how far the ray passes the strip, m; below 0: within it */
};

/* near_a to far_b: the t at which light enters and leaves the slabs of the strip's two axes. */
REAL_FN S(sun_crossed) sun_cross_strip(float4 strip, real near_a, real near_b, real far_a,
                                       real far_b, float spread, float radius)
{
    real one = (far_b - near_a) * strip.w, other = (far_a - near_b) * strip.w;
    real one_at = (near_a * strip.y + far_b * strip.x) * strip.z;
    real other_at = (near_b * strip.x + far_a * strip.y) * strip.z;
    real cover = disc_cover(one / sun_penumbra(one_at, spread, radius)) +
                 disc_cover(other / sun_penumbra(other_at, spread, radius)) - 1.0f;
    S(sun_crossed) crossed;
    crossed.cover = real_max(cover, real_all(0.0f));
    crossed.outside = -real_min(one, other);
    return crossed;
}

/* Combines the covers of two strips. At a corner of the outline they are multiplied; but where the
 * sun is across an axis, two of the strips end at the same edge, which counts once. */
REAL_FN real both_strips(real a, real b, float alike)
{
    return a * b + (real_min(a, b) - a * b) * alike;
}

struct sun_hidden {
    real cover;
    real exit_distance; /* how far light goes until it leaves the box, m */
};

/* Computes the cover of a box from where the light's ray crosses its slabs. For a ray that passes
 * beside the outline, the way is that of a ray through the outline's edge and `margin` metres
 * further inside, which leaves the slabs later by at most sun_edges.later for each metre. */
REAL_FN S(sun_hidden) sun_cross_box(S(ray_slabs) s, S(sun_edges) e, float margin, float spread,
                                    float radius)
{
    S(sun_crossed) xy = sun_cross_strip(e.xy, s.near.x, s.near.y, s.far.x, s.far.y, spread, radius);
    S(sun_crossed) yz = sun_cross_strip(e.yz, s.near.y, s.near.z, s.far.y, s.far.z, spread, radius);
    S(sun_crossed) xz = sun_cross_strip(e.xz, s.near.x, s.near.z, s.far.x, s.far.z, spread, radius);
    real outside = real_max(real_max(xy.outside, real_all(0.0f)), real_max(yz.outside, xz.outside));
    real aside = outside + margin;
    S(sun_hidden) box;
    box.cover = both_strips(both_strips(yz.cover, xz.cover, e.alike.x), xy.cover, e.alike.y);
    box.exit_distance = real_min(real_min(s.far.x + aside * e.later.x, s.far.y + aside * e.later.y),
                                 s.far.z + aside * e.later.z);
    return box;
}

/* ---- round shapes ---------------------------------------------------------------------------- */

/* Returns the cover of a ball. towards: the way to its centre; spread: as for sun_penumbra. */
REAL_FN real ball_cover(real3 towards, float radius, float4 sun, float spread)
{
    real t = real3_dot_all(towards, sun);
    real across = real3_length(real3_add_scaled(towards, real3_all(sun), -t));
    return real_where(t >= 0.0f, strip_cover(radius - across, radius + across, t * spread));
}

/* Returns the way to a ball: of the balls that form a capsule, the one that light passes most
 * closely. */
REAL_FN real3 capsule_nearest(real3 towards, float4 axis, float4 sun)
{
    float climb = axis.x * sun.x + axis.y * sun.y + axis.z * sun.z;
    float4 level =
        FLOAT4(axis.x - sun.x * climb, axis.y - sun.y * climb, axis.z - sun.z * climb, 0.0f);
    float square = level.x * level.x + level.y * level.y + level.z * level.z;
    real along = real3_dot_all(towards, level) * (-1.0f / exact_max(square, 1e-6f));
    return real3_add_scaled(towards, real3_all(axis), real_clamp(along, -axis.w, axis.w));
}

/* Returns the cover of a capped cylinder. towards: the way to its middle; axis: w: half of its
 * height. */
REAL_FN real cylinder_cover(real3 towards, float radius, float4 axis, float4 sun, S(sun_band) band,
                            float spread)
{
    real x = real3_dot_all(towards, band.right), y = real3_dot_all(towards, band.up);
    real along = real_clamp(-y * (1.0f / (band.lean.y * band.lean.z)), -axis.w, axis.w);
    real t = real_max(real3_dot_all(towards, sun) + along * band.lean.x, real_all(0.0f));
    real inside = real_sqrt(real_max(radius * radius - x * x, real_all(0.0f)));
    real end = axis.w * band.lean.y + exact_abs(band.lean.x) * inside;
    real sides = strip_cover(radius - real_abs(x), radius + real_abs(x), t * spread);
    real ends = strip_cover(end - real_abs(y), end + real_abs(y), t * spread);
    /* Light that starts beside the cylinder or beyond an end may only lead away from it. */
    real height = -real3_dot_all(towards, axis);
    real3 aside = real3_add_scaled(towards, real3_all(axis), height);
    truth beyond = truth_and(real_abs(height) >= axis.w, height * band.lean.x > 0.0f);
    truth beside =
        truth_and(real3_dot(aside, aside) >= radius * radius, real3_dot_all(aside, sun) < 0.0f);
    return real_where(truth_not(truth_or(beyond, beside)), sides * ends);
}

/* Returns the cover of a small ball, which may be smaller than the sun's disc: the common part of
 * two discs, within 3 % of the exact one. The cover fades out as the penumbra grows, and is 0 where
 * the penumbra is `fade` times as wide as the ball. */
REAL_FN real speck_cover(real3 towards, real size, float4 sun, float spread, float fade)
{
    real t = real3_dot_all(towards, sun);
    real across = real3_length(real3_add_scaled(towards, real3_all(sun), -t));
    real radius = real_max(t * spread, real_all(1e-5f));
    real smaller = real_min(radius, size), ratio = smaller / real_max(radius, size);
    real x = real_clamp01((radius + size - across) / (2.0f * smaller));
    real large_over_small = x * x * (3.0f - 2.0f * x), like_over_like = x * (0.55f + 0.45f * x);
    real part = large_over_small + (like_over_like - large_over_small) * ratio;
    real most = smaller / radius;
    real left = real_clamp01(2.0f - 2.0f * radius / (size * fade));
    return real_where(t > 0.0f, part * most * most * left);
}

#endif
