/* Computes how much of a light convex shapes hide from a point: penumbras without samples. At the
 * distance of an edge, the light to the point passes through a disc. The cover is the part of this
 * disc beyond the edge, 0 to 1. For a ball that is lit, the disc's radius grows by the ball's. The
 * sun is in one direction from all points; lamp_cover.h does the same for lamps, which are near. */
#ifndef KILN_SHARED_SUN_COVER_H
#define KILN_SHARED_SUN_COVER_H

#include "shared/exact.h"
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

/* Returns the radius of the disc at a distance along the ray, m. spread: how much it grows for each
 * metre; radius: of the ball that is lit, m, where the disc begins; 0 for a point. */
REAL_FN real sun_penumbra(real along, real spread, real radius)
{
    return real_max(real_max(along, real_all(0.0f)) * spread + radius, real_all(1e-5f));
}

/* Returns the part of a ball, 0 to 1, that lies on the positive side of a plane. distance: of the
 * ball's centre from the plane, m; radius: 0 for a point. */
REAL_FN real cover_side(real distance, real radius)
{
    return real_clamp01(0.5f + distance * (0.5f / real_max(radius, real_all(1e-6f))));
}

/* ---- boxes ----------------------------------------------------------------------------------- */

/* Returns the radius of a box's bounding sphere, m. halves: of its size. */
FN float box_radius(float3 halves)
{
    return SQRT(float3_dot(halves, halves));
}

/* The outline of a box as seen along a ray. It is a hexagon, the intersection of three strips. The
 * two edges of a strip are edges of the box that lie along one axis. At each, a face that light
 * enters, of one of the other two axes, meets a face that light leaves, of the other. */
struct box_strip {
    real first, second; /* squares of 1 / direction along these two axes */
    real inverse;       /* 1 / (first + second) */
    real root;          /* of inverse */
};

struct box_outline {
    real3 later; /* how much later light leaves a slab for each metre that it passes aside */
    S(box_strip) xy, yz, xz;
    /* How much two edges coincide in the outline, 1 if they are parallel there: edges along x and
     * y; edges along z and another axis. */
    real alike_xy, alike_z;
};

REAL_FN S(box_strip) box_strip_of(real inverse_a, real inverse_b)
{
    S(box_strip) strip;
    strip.first = inverse_a * inverse_a;
    strip.second = inverse_b * inverse_b;
    strip.root = real_rsqrt(strip.first + strip.second);
    strip.inverse = strip.root * strip.root;
    return strip;
}

/* Returns the eighth power of the cosine between two edges in the outline. a, b: the light's
 * direction along their axes. */
REAL_FN real box_likeness(real a, real b)
{
    real aa = a * a, bb = b * b;
    real square = aa * bb / real_max((1.0f - aa) * (1.0f - bb), real_all(1e-12f));
    square = real_min(square, real_all(1.0f));
    square *= square;
    return square * square;
}

REAL_FN real box_later(real inverse)
{
    return real_sqrt(real_max(inverse * inverse - 1.0f, real_all(0.0f)));
}

/* Returns the outline of a box. way: unit, to the light in the box's frame; inverse: its
 * ray_inverse3. */
REAL_FN S(box_outline) box_outline_of(real3 way, real3 inverse)
{
    S(box_outline) o;
    o.later = REAL3(box_later(inverse.x), box_later(inverse.y), box_later(inverse.z));
    o.xy = box_strip_of(inverse.x, inverse.y);
    o.yz = box_strip_of(inverse.y, inverse.z);
    o.xz = box_strip_of(inverse.x, inverse.z);
    o.alike_xy = box_likeness(way.x, way.y);
    o.alike_z = real_max(box_likeness(way.y, way.z), box_likeness(way.x, way.z));
    return o;
}

REAL_FN S(box_strip) box_strip_all(float4 shared_by_all)
{
    S(box_strip) strip;
    strip.first = real_all(shared_by_all.x);
    strip.second = real_all(shared_by_all.y);
    strip.inverse = real_all(shared_by_all.z);
    strip.root = real_all(shared_by_all.w);
    return strip;
}

/* Returns the outline that all points see, since the sun is in one direction from all of them. */
REAL_FN S(box_outline) box_outline_all(S(sun_edges) edges)
{
    S(box_outline) o;
    o.later = real3_all(edges.later);
    o.xy = box_strip_all(edges.xy);
    o.yz = box_strip_all(edges.yz);
    o.xz = box_strip_all(edges.xz);
    o.alike_xy = real_all(edges.alike.x);
    o.alike_z = real_all(edges.alike.y);
    return o;
}

/* The two edges of a strip: how far inside of each the ray passes, m, below 0 outside; and how far
 * along the ray it passes them, m. */
struct box_edges {
    real one, other, one_at, other_at;
};

/* near_a to far_b: the t at which light enters and leaves the slabs of the strip's two axes. */
REAL_FN S(box_edges) box_edges_of(S(box_strip) strip, real near_a, real near_b, real far_a,
                                  real far_b)
{
    S(box_edges) edges;
    edges.one = (far_b - near_a) * strip.root;
    edges.other = (far_a - near_b) * strip.root;
    edges.one_at = (near_a * strip.second + far_b * strip.first) * strip.inverse;
    edges.other_at = (near_b * strip.first + far_a * strip.second) * strip.inverse;
    return edges;
}

/* Return the edges of each strip of a box, from where the light's ray crosses the box's slabs. */
REAL_FN S(box_edges) box_edges_xy(S(ray_slabs) s, S(box_outline) o)
{
    return box_edges_of(o.xy, s.near.x, s.near.y, s.far.x, s.far.y);
}

REAL_FN S(box_edges) box_edges_yz(S(ray_slabs) s, S(box_outline) o)
{
    return box_edges_of(o.yz, s.near.y, s.near.z, s.far.y, s.far.z);
}

REAL_FN S(box_edges) box_edges_xz(S(ray_slabs) s, S(box_outline) o)
{
    return box_edges_of(o.xz, s.near.x, s.near.z, s.far.x, s.far.z);
}

/* Returns how far the ray passes outside of a strip, m; below 0: within it. */
REAL_FN real box_strip_outside(S(box_edges) edges)
{
    return -real_min(edges.one, edges.other);
}

/* Returns the cover of a strip. */
REAL_FN real box_strip_cover(S(box_edges) edges, real spread, real radius)
{
    real cover = disc_cover(edges.one / sun_penumbra(edges.one_at, spread, radius)) +
                 disc_cover(edges.other / sun_penumbra(edges.other_at, spread, radius)) - 1.0f;
    return real_max(cover, real_all(0.0f));
}

/* Combines the covers of two strips. At a corner of the outline they are multiplied; but where the
 * light is across an axis, two of the strips end at the same edge, which counts once. */
REAL_FN real both_strips(real a, real b, real alike)
{
    return a * b + (real_min(a, b) - a * b) * alike;
}

struct box_span {
    real enter, exit; /* how far light goes until it enters and leaves, m */
};

/* Finds where light crosses a box, from where its ray crosses the box's slabs. For a ray that
 * passes beside the outline, the way is that of a ray through the outline's edge and `margin`
 * metres further inside, which leaves the slabs later by at most `later` for each metre. */
REAL_FN S(box_span) box_span_of(S(ray_slabs) s, S(box_outline) o, float margin)
{
    real xy = box_strip_outside(box_edges_xy(s, o));
    real yz = box_strip_outside(box_edges_yz(s, o));
    real xz = box_strip_outside(box_edges_xz(s, o));
    real outside = real_max(real_max(xy, real_all(0.0f)), real_max(yz, xz));
    real aside = outside + margin;
    real3 later = REAL3(aside * o.later.x, aside * o.later.y, aside * o.later.z);
    S(box_span) span;
    span.enter = real_max(real_max(s.near.x - later.x, s.near.y - later.y), s.near.z - later.z);
    span.exit = real_min(real_min(s.far.x + later.x, s.far.y + later.y), s.far.z + later.z);
    return span;
}

/* Returns the cover of a box, from where the light's ray crosses its slabs. */
REAL_FN real box_cover(S(ray_slabs) s, S(box_outline) o, real spread, real radius)
{
    real xy = box_strip_cover(box_edges_xy(s, o), spread, radius);
    real yz = box_strip_cover(box_edges_yz(s, o), spread, radius);
    real xz = box_strip_cover(box_edges_xz(s, o), spread, radius);
    return both_strips(both_strips(yz, xz, o.alike_xy), xy, o.alike_z);
}

/* ---- round shapes ---------------------------------------------------------------------------- */

/* Holds the part of a light that a shape hides, and how far from the point it does, m. */
struct cover_at {
    real cover, distance;
};

/* Returns the cover of a ball. towards: the way to its centre; way: unit, to the light; spread,
 * lit: as `spread` and `radius` for sun_penumbra. */
REAL_FN S(cover_at) ball_cover(real3 towards, float radius, real3 way, real spread, real lit)
{
    real t = real3_dot(towards, way);
    real across = real3_length(real3_add_scaled(towards, way, -t));
    S(cover_at) at;
    at.cover = strip_cover(radius - across, radius + across, t * spread + lit) * cover_side(t, lit);
    at.distance = t;
    return at;
}

/* Returns the way to a ball: of the balls that form a capsule, the one that light passes most
 * closely. */
REAL_FN real3 capsule_nearest(real3 towards, float4 axis, real3 way)
{
    real climb = real3_dot_all(way, axis);
    real3 level = real3_add_scaled(real3_all(axis), way, -climb);
    real square = real3_dot(level, level);
    real along = real3_dot(towards, level) * (-1.0f / real_max(square, real_all(1e-6f)));
    return real3_add_scaled(towards, real3_all(axis), real_clamp(along, -axis.w, axis.w));
}

/* How a capped cylinder looks along a ray: a band along `up`, with round ends. */
struct cover_band {
    real3 right, up;
    /* Sine and cosine of the angle between the axis and the plane across the ray. */
    real climb, slant;
    real side; /* 1 if the axis points along `up`, -1 if against it */
};

/* Returns the band of a cylinder. axis: unit; aside: unit, across the ray, for a cylinder that is
 * seen along its axis. */
REAL_FN S(cover_band) cover_band_of(float4 axis, real3 way, real3 aside)
{
    S(cover_band) band;
    band.climb = real3_dot_all(way, axis);
    band.slant = real_sqrt(real_max(1.0f - band.climb * band.climb, real_all(1e-6f)));
    real3 across = real3_cross(real3_all(axis), way);
    real3 level = real3_scale(across, 1.0f / band.slant);
    band.right = real3_select(band.slant > 1e-3f, level, aside);
    band.up = real3_cross(way, band.right);
    band.side = real_sign_one(real3_dot_all(band.up, axis));
    return band;
}

REAL_FN S(cover_band) cover_band_all(S(sun_band) shared_by_all)
{
    S(cover_band) band;
    band.right = real3_all(shared_by_all.right);
    band.up = real3_all(shared_by_all.up);
    band.climb = real_all(shared_by_all.lean.x);
    band.slant = real_all(shared_by_all.lean.y);
    band.side = real_all(shared_by_all.lean.z);
    return band;
}

/* Holds the parts of a lit point or ball from which the way to the light leads away from a
 * cylinder: the part that lies beyond an end of it, and the part beside it. */
struct cylinder_past {
    real beyond, beside;
};

/* towards, axis, way, lit: as for cylinder_cover; climb: the cosine between way and axis. */
REAL_FN S(cylinder_past) cylinder_past_of(real3 towards, float radius, float4 axis, real3 way,
                                          real climb, real lit)
{
    real height = -real3_dot_all(towards, axis);
    real3 aside = real3_add_scaled(towards, real3_all(axis), height);
    S(cylinder_past) past;
    past.beyond = real_where(height * climb > 0.0f, cover_side(real_abs(height) - axis.w, lit));
    past.beside =
        cover_side(real3_length(aside) - radius, lit) * cover_side(-real3_dot(aside, way), lit);
    return past;
}

/* Returns the cover of a capped cylinder. towards: the way to its middle; axis: w: half of its
 * height; way: unit, to the light; spread, lit: as for ball_cover. */
REAL_FN S(cover_at) cylinder_cover(real3 towards, float radius, float4 axis, real3 way,
                                   S(cover_band) band, real spread, real lit)
{
    real x = real3_dot(towards, band.right), y = real3_dot(towards, band.up);
    real along = real_clamp(-y * (1.0f / (band.slant * band.side)), -axis.w, axis.w);
    real t = real_max(real3_dot(towards, way) + along * band.climb, real_all(0.0f));
    real inside = real_sqrt(real_max(radius * radius - x * x, real_all(0.0f)));
    real end = axis.w * band.slant + real_abs(band.climb) * inside;
    real disc = t * spread + lit;
    real sides = strip_cover(radius - real_abs(x), radius + real_abs(x), disc);
    real ends = strip_cover(end - real_abs(y), end + real_abs(y), disc);
    S(cylinder_past) past = cylinder_past_of(towards, radius, axis, way, band.climb, lit);
    S(cover_at) at;
    at.cover = sides * ends * (1.0f - past.beyond) * (1.0f - past.beside);
    at.distance = t;
    return at;
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
