/* Computes how much of a lamp convex shapes hide from a point, by the functions of sun_cover.h. A
 * lamp is a ball; the light of fire is gathered into lamps too. Each point sees it in a direction
 * and at a distance of its own: its light fills a cone, so a penumbra is wide where the shape is
 * near the lamp. A shape behind the lamp hides nothing. */
#ifndef KILN_SHARED_LAMP_COVER_H
#define KILN_SHARED_LAMP_COVER_H

#include "shared/draw_layout.h"
#include "shared/sun_cover.h"

/* How far rays to lamps start off their surface, m; and how far inside of a box's outline a ray
 * counts as passing through the box, m, which is less, and more than rounding displaces a ray. */
#define LAMP_START    1e-3f
#define LAMP_BOX_EDGE 1e-4f

/* The way from a point, or from a ball, to a lamp. Light fills a cone between the two. */
struct lamp_way {
    real3 direction; /* unit */
    real reach;      /* distance of the lamp's centre, m */
    real lit;        /* radius of the ball that is lit, m; 0 for a point */
    real radius;     /* of the lamp, m */
    real spread;     /* how much the cone's radius grows for each metre; may be below 0 */
    real depth;      /* half of the lamp's extent along the way, m */
};

/* towards: from the point to the lamp's centre, m; radius: of the lamp, m; lit: of the ball, m. */
REAL_FN S(lamp_way) lamp_way_of(real3 towards, float radius, real lit)
{
    real square = real_max(real3_dot(towards, towards), real_all(1e-12f));
    real inverse = real_rsqrt(square);
    S(lamp_way) way;
    way.direction = real3_scale(towards, inverse);
    way.reach = square * inverse;
    way.lit = lit;
    way.radius = real_all(radius);
    way.spread = (radius - lit) * inverse;
    way.depth = way.radius;
    return way;
}

/* Returns the way from a point of a surface, or from a ball, to a lamp. lit: radius of the ball, m;
 * 0 for a point. A rectangle hides as a disc of its area does. Where a part of the disc is below
 * the surface's horizon, the whole disc is lifted above it, since the surface gets light only from
 * the part of the rectangle above (rectangle_irradiance). */
REAL_FN S(lamp_way) lamp_way_to(S(kiln_draw_light) lamp, real3 origin, real3 normal, real lit)
{
    real3 towards = real3_towards(lamp.position_radius2, origin);
    if (lamp.facing.w != KILN_LAMP_RECTANGLE)
        return lamp_way_of(towards, lamp.color.w, lit);
    real lift = real_max(lamp.color.w - real3_dot(normal, towards), real_all(0.0f));
    S(lamp_way) way = lamp_way_of(real3_add_scaled(towards, normal, lift), lamp.color.w, lit);
    way.depth = real_abs(real3_dot_all(way.direction, lamp.right)) +
                real_abs(real3_dot_all(way.direction, lamp.up));
    return way;
}

/* Returns the part of the lamp's extent that is farther away than `distance`, m: a shape there
 * hides no more than this part. */
REAL_FN real lamp_part_beyond(S(lamp_way) way, real distance)
{
    real depth = real_max(way.depth, real_all(1e-4f));
    return real_clamp01(0.5f + 0.5f * (way.reach - distance) / depth);
}

/* Returns where a shape may hide a part of the lamp. towards: the way to the centre of the shape's
 * bounding sphere; size: the sphere's radius, m. */
REAL_FN truth lamp_meets(real3 towards, float size, S(lamp_way) way)
{
    real t = real3_dot(towards, way.direction);
    real3 across = real3_add_scaled(towards, way.direction, -t);
    real along = real_clamp01((t + size) / way.reach);
    real disc = real_max(real_mix(way.lit, way.radius, along), way.lit);
    real wide = size + disc + 1e-3f;
    return truth_and(truth_and(t > -size - way.lit, t < way.reach + way.radius + size),
                     real3_dot(across, across) < wide * wide);
}

/* Returns the cover of a ball. A ball smaller than the lamp's disc hides no more than its share. */
REAL_FN real lamp_ball_cover(real3 towards, float radius, S(lamp_way) way)
{
    S(cover_at) at = ball_cover(towards, radius, way.direction, way.spread, way.lit);
    real disc = real_max(at.distance * way.spread + way.lit, real_all(1e-5f));
    return at.cover * real_min(radius / disc, real_all(1.0f)) * lamp_part_beyond(way, at.distance);
}

/* Returns the cover of a capsule. axis: unit; w: half of its height without the ends. */
REAL_FN real lamp_capsule_cover(real3 towards, float radius, float4 axis, S(lamp_way) way)
{
    return lamp_ball_cover(capsule_nearest(towards, axis, way.direction), radius, way);
}

/* Returns a unit vector across an axis. */
FN float3 lamp_across(float4 axis)
{
    float3 from = FLOAT3(0.0f, axis.z, -axis.y);
    if (exact_abs(axis.x) > 0.7f)
        from = FLOAT3(-axis.z, 0.0f, axis.x);
    return float3_scale(from, 1.0f / SQRT(float3_dot(from, from)));
}

/* Returns the cover of a capped cylinder. axis: unit; w: half of its height. */
REAL_FN real lamp_cylinder_cover(real3 towards, float radius, float4 axis, S(lamp_way) way)
{
    S(cover_band) band = cover_band_of(axis, way.direction, real3_all(lamp_across(axis)));
    S(cover_at) at =
        cylinder_cover(towards, radius, axis, way.direction, band, way.spread, way.lit);
    return at.cover * lamp_part_beyond(way, at.distance);
}

/* Returns the cover of a box. towards: the way to its centre; halves: of its size; direction: to
 * the lamp. All are along the box's axes. */
REAL_FN real lamp_box_cover(real3 towards, float4 halves, real3 direction, S(lamp_way) way)
{
    real3 inverse = ray_inverse3(direction);
    S(ray_slabs) slabs = ray_cross_slabs(towards, halves, inverse);
    S(box_outline) outline = box_outline_of(direction, inverse);
    S(box_span) span = box_span_of(slabs, outline, LAMP_BOX_EDGE);
    return box_cover(slabs, outline, way.spread, way.lit) * cover_side(span.exit, way.lit) *
           lamp_part_beyond(way, span.enter);
}

/* Returns the part of a lamp that a plane hides from all places above it. height: of the lamp's
 * centre above the plane, m. */
REAL_FN real lamp_plane_cover(real height, float radius)
{
    return disc_cover(-height / exact_max(radius, 1e-5f));
}

#endif
