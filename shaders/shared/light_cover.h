/* Computes how much of a light a shape hides from a point or from a ball: penumbras without
 * samples. The light of a lamp fills a cone between what is lit and the lamp. At the distance of a
 * shape's edge, the cone is a disc, and the cover is the part of this disc beyond the edge, 0 to 1.
 * A shape behind the lamp hides nothing. The sun is a lamp that is infinitely far away. */
#ifndef KILN_SHARED_LIGHT_COVER_H
#define KILN_SHARED_LIGHT_COVER_H

#include "shared/draw_layout.h"
#include "shared/exact.h"
#include "shared/real.h"

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

/* ---- ways to lights -------------------------------------------------------------------------- */

/* How far rays to lights start off their surface, m. */
#define LIGHT_START 1e-3f

/* The way from a point, or from a ball, to a light. Light fills a cone between the two. */
struct light_way {
    real3 direction; /* unit */
    real reach;      /* distance of the light's centre, m */
    real lit;        /* radius of the ball that is lit, m; 0 for a point */
    real radius;     /* of the light, m; of the sun, which is nowhere, 0 */
    real spread;     /* how much the cone's radius grows for each metre; may be below 0 */
    real depth;      /* half of the light's extent along the way, m */
    /* The part of a ball that counts as hidden while the way leaves a shape at the ball's centre.
     */
    float half_in;
};

/* Distance of the sun, m. It is beyond all shapes, and its square is a finite number. */
#define LIGHT_SUN_REACH 1e9f

/* Returns the way to the sun. direction: unit; spread: tangent of the sun's angular radius. */
REAL_FN S(light_way) sun_way_of(float4 direction, float spread, real lit)
{
    S(light_way) way;
    way.direction = real3_all(direction);
    way.reach = real_all(LIGHT_SUN_REACH);
    way.lit = lit;
    way.radius = real_all(0.0f);
    way.spread = real_all(spread);
    way.depth = real_all(1.0f);
    way.half_in = 0.0f;
    return way;
}

/* Returns the way to a lamp. towards: from the point to the lamp's centre, m; radius: of the lamp,
 * m; lit: of the ball, m. */
REAL_FN S(light_way) lamp_way_of(real3 towards, float radius, real lit)
{
    real square = real_max(real3_dot(towards, towards), real_all(1e-12f));
    real inverse = real_rsqrt(square);
    S(light_way) way;
    way.direction = real3_scale(towards, inverse);
    way.reach = square * inverse;
    way.lit = lit;
    way.radius = real_all(radius);
    way.spread = (radius - lit) * inverse;
    way.depth = way.radius;
    way.half_in = 0.5f;
    return way;
}

/* Returns the way from a point of a surface, or from a ball, to a lamp. lit: radius of the ball, m;
 * 0 for a point. A rectangle hides as a disc of its area does. Where a part of the disc is below
 * the surface's horizon, the whole disc is lifted above it, since the surface gets light only from
 * the part of the rectangle above (rectangle_irradiance). */
REAL_FN S(light_way) lamp_way_to(S(kiln_draw_light) lamp, real3 origin, real3 normal, real lit)
{
    real3 towards = real3_towards(lamp.position_radius2, origin);
    if (!LAMP_IS_RECTANGLE(lamp))
        return lamp_way_of(towards, lamp.color.w, lit);
    real lift = real_max(lamp.color.w - real3_dot(normal, towards), real_all(0.0f));
    S(light_way) way = lamp_way_of(real3_add_scaled(towards, normal, lift), lamp.color.w, lit);
    way.depth = real_abs(real3_dot_all(way.direction, lamp.right)) +
                real_abs(real3_dot_all(way.direction, lamp.up));
    return way;
}

/* Returns the radius of the cone of light at a distance along the way, m. */
REAL_FN real light_disc(S(light_way) way, real along)
{
    return real_max(real_max(along, real_all(0.0f)) * way.spread + way.lit, real_all(1e-5f));
}

/* Returns the largest radius that the cone has up to a distance along the way, m. */
REAL_FN real light_widest(S(light_way) way, real along)
{
    return way.lit + real_max(way.spread, real_all(0.0f)) * real_max(along, real_all(0.0f));
}

/* Returns where a shape may hide a part of the light. towards: the way to the centre of the shape's
 * bounding sphere; size: the sphere's radius, m. */
REAL_FN truth light_meets_sphere(S(light_way) way, real3 towards, float size)
{
    real t = real3_dot(towards, way.direction);
    real3 across = real3_add_scaled(towards, way.direction, -t);
    real wide = light_widest(way, t + size) + (size + 1e-3f);
    return truth_and(truth_and(t > -size - way.lit, t < way.reach + way.radius + size),
                     real3_dot(across, across) < wide * wide);
}

/* Returns the part of a light's extent that is farther away than `distance`, m: a shape there hides
 * no more than this part. */
REAL_FN real light_beyond(S(light_way) way, real distance)
{
    real depth = real_max(way.depth, real_all(1e-4f));
    return real_clamp01(0.5f + 0.5f * (way.reach - distance) / depth);
}

/* Returns where a shape that is this far away has a penumbra as wide as the ball that is lit. */
REAL_FN truth light_blurs(S(light_way) way, real distance)
{
    return distance * (way.radius / way.reach) >= way.lit;
}

/* Holds what a shape hides of a light. */
struct light_cover {
    real cover;    /* part of the cone that is beyond the shape's edges */
    real distance; /* to where the shape hides it, m */
    real leaves;   /* distance to where the way leaves the shape, m; below 0: it is behind */
};

/* Returns where a shape hides something of a light if its cover is not 0. Elsewhere it is behind
 * what is lit, or farther away than the light. */
REAL_FN truth light_is_behind(S(light_way) way, S(light_cover) at)
{
    real farthest = way.reach + real_max(way.depth, real_all(1e-4f));
    return truth_and(at.leaves > -way.lit, at.distance < farthest);
}

/* Returns the part of a light that a shape hides from a point or a ball. */
REAL_FN real light_hidden(S(light_way) way, S(light_cover) at)
{
    real scale = (1.0f - way.half_in) / real_max(way.lit, real_all(1e-6f));
    real before = real_clamp01(way.half_in + at.leaves * scale);
    return at.cover * before * light_beyond(way, at.distance);
}

/* ---- specks ---------------------------------------------------------------------------------- */

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
