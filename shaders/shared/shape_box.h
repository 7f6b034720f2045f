/* Draws boxes, which lie along the axes of the world or in a frame of their own, and lets particles
 * collide with the latter (collide_box.h has the former). */
/* NOLINTBEGIN(misc-unused-parameters): all kinds have the same parameters */
#if defined(KILN_SHARED_SHAPE_H) && !defined(KILN_BOX_DRAWN)
#define KILN_BOX_DRAWN

/* ---- rays ------------------------------------------------------------------------------------ */

/* The t at which a ray enters and leaves the slab of each axis of a box. */
struct ray_slabs {
    real3 near, far;
};

/* Intersects the slabs of a box. All is along the box's axes; inverse: ray_inverse3 of the ray's
 * direction. */
REAL_FN S(ray_slabs) box_slabs(real3 towards, float4 halves, real3 inverse)
{
    real3 middle = REAL3(towards.x * inverse.x, towards.y * inverse.y, towards.z * inverse.z);
    real3 extent = REAL3(halves.x * real_abs(inverse.x), halves.y * real_abs(inverse.y),
                         halves.z * real_abs(inverse.z));
    S(ray_slabs) slabs;
    slabs.near = real3_sub(middle, extent);
    slabs.far = real3_add(middle, extent);
    return slabs;
}

REAL_FN S(ray_interval) box_interval(S(ray_slabs) s)
{
    return ray_interval_of(real_max(real_max(s.near.x, s.near.y), s.near.z),
                           real_min(real_min(s.far.x, s.far.y), s.far.z));
}

/* Returns how far a box extends from its centre along a unit vector of its frame, m. */
REAL_FN real box_extent(float4 halves, real3 way)
{
    return real_abs(way.x) * halves.x + real_abs(way.y) * halves.y + real_abs(way.z) * halves.z;
}

/* Returns ray_inverse3 of a ray's direction along the axes of a box. */
REAL_FN real3 box_ray_inverse(S(kiln_draw_shape) s, S(shape_ray) ray)
{
#ifndef GL_core_profile
    if (s.kind.y == 0u)
        return ray.inverse;
#endif
    return ray_inverse3(shape_into(s, ray.direction));
}

REAL_FN S(ray_interval) box_cross(S(kiln_draw_shape) s, S(shape_ray) ray)
{
    real3 inverse = box_ray_inverse(s, ray);
    return box_interval(
        box_slabs(shape_into(s, real3_towards(s.center, ray.origin)), s.extent, inverse));
}

/* A ray enters a box by the slab that it enters last. */
REAL_FN S(shape_face) box_face(S(kiln_draw_shape) s, S(shape_ray) ray, real t)
{
    real3 inverse = box_ray_inverse(s, ray);
    S(ray_slabs) at =
        box_slabs(shape_into(s, real3_towards(s.center, ray.origin)), s.extent, inverse);
    truth x = truth_and(at.near.x >= at.near.y, at.near.x >= at.near.z);
    truth y = truth_and(truth_not(x), at.near.y >= at.near.z);
    truth z = truth_not(truth_or(x, y));
    real3 normal =
        REAL3(real_where(x, -real_sign_one(inverse.x)), real_where(y, -real_sign_one(inverse.y)),
              real_where(z, -real_sign_one(inverse.z)));
    S(shape_face) face;
    face.normal = shape_out_of(s, normal);
    face.number = normal.x + 2.0f * normal.y + 4.0f * normal.z;
    return face;
}

/* ---- light ----------------------------------------------------------------------------------- */

/* The outline of a box as seen along a ray. It is a hexagon, the intersection of three strips. The
 * two edges of a strip are edges of the box that lie along one axis. At each, a face that light
 * enters, of one of the other two axes, meets a face that light leaves, of the other. */
struct box_strip {
    real first, second; /* squares of 1 / direction along these two axes */
    real root;          /* of 1 / (first + second) */
};

/* A box as seen in a direction. */
struct box_seen {
    real3 direction, inverse; /* to the light in the box's frame; ray_inverse3 of it */
    real3 later; /* how much later light leaves a slab for each metre that it passes aside */
    S(box_strip) xy, yz, xz;
};

REAL_FN S(box_strip) box_strip_of(real inverse_a, real inverse_b)
{
    S(box_strip) strip;
    strip.first = inverse_a * inverse_a;
    strip.second = inverse_b * inverse_b;
    strip.root = real_rsqrt(strip.first + strip.second);
    return strip;
}

REAL_FN real box_later(real inverse)
{
    return real_sqrt(real_max(inverse * inverse - 1.0f, real_all(0.0f)));
}

REAL_FN S(box_seen) box_seen_along(S(kiln_draw_shape) s, real3 direction)
{
    S(box_seen) seen;
    seen.direction = shape_into(s, direction);
    seen.inverse = ray_inverse3(seen.direction);
    seen.later =
        REAL3(box_later(seen.inverse.x), box_later(seen.inverse.y), box_later(seen.inverse.z));
    seen.xy = box_strip_of(seen.inverse.x, seen.inverse.y);
    seen.yz = box_strip_of(seen.inverse.y, seen.inverse.z);
    seen.xz = box_strip_of(seen.inverse.x, seen.inverse.z);
    return seen;
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
    real inverse = strip.root * strip.root;
    edges.one_at = (near_a * strip.second + far_b * strip.first) * inverse;
    edges.other_at = (near_b * strip.first + far_a * strip.second) * inverse;
    return edges;
}

/* Returns how far the ray passes outside of a strip, m; below 0: within it. */
REAL_FN real box_outside(S(box_edges) edges)
{
    return -real_min(edges.one, edges.other);
}

/* Returns the cover of a strip in the lanes of a mask. Where each of them is beyond the penumbras
 * of both edges, the cover is 0 or 1 and needs no division. */
REAL_FN real box_strip_cover(S(box_edges) edges, truth near, S(light_way) way)
{
    real one = light_disc(way, edges.one_at), other = light_disc(way, edges.other_at);
    truth blurred = truth_or(real_abs(edges.one) < one, real_abs(edges.other) < other);
    truth inside = truth_and(edges.one > 0.0f, edges.other > 0.0f);
    if (!real_some(truth_and(near, blurred)))
        return real_where(inside, real_all(1.0f));
    real cover = disc_cover(edges.one / one) + disc_cover(edges.other / other) - 1.0f;
    return real_max(cover, real_all(0.0f));
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

/* Combines the covers of two strips. At a corner of the outline they are multiplied; but where the
 * light is across an axis, two of the strips end at the same edge, which counts once. alike: how
 * much two edges coincide in the outline, 1 if they are parallel there. */
REAL_FN real box_both(real a, real b, real alike)
{
    return a * b + (real_min(a, b) - a * b) * alike;
}

/* Combines the covers of all strips. way: unit, to the light in the box's frame. */
REAL_FN real box_all(real yz, real xz, real xy, real3 way, truth near)
{
    real all = yz * xz * xy;
    truth parts = truth_and(all > 0.0f, all < 1.0f);
    if (!real_some(truth_and(near, parts)))
        return all;
    real alike_z = real_max(box_likeness(way.y, way.z), box_likeness(way.x, way.z));
    return box_both(box_both(yz, xz, box_likeness(way.x, way.y)), xy, alike_z);
}

/* How far inside of a box's outline a ray counts as passing through the box, m: more than rounding
 * displaces a ray, and less than the distance by which rays start off surfaces. */
#define BOX_EDGE 1e-4f

/* Returns what a box hides in the lanes of a mask. For a ray that passes beside the outline, the
 * way through the box is that of a ray through the outline's edge and BOX_EDGE further inside,
 * which leaves the slabs later by at most `later` for each metre. */
REAL_FN S(light_cover) box_cover(S(kiln_draw_shape) s, S(box_seen) seen, real3 towards,
                                 S(light_way) way, truth near)
{
    S(ray_slabs) at = box_slabs(shape_into(s, towards), s.extent, seen.inverse);
    S(box_edges) xy = box_edges_of(seen.xy, at.near.x, at.near.y, at.far.x, at.far.y);
    S(box_edges) yz = box_edges_of(seen.yz, at.near.y, at.near.z, at.far.y, at.far.z);
    S(box_edges) xz = box_edges_of(seen.xz, at.near.x, at.near.z, at.far.x, at.far.z);
    real outside = real_max(real_max(box_outside(xy), real_all(0.0f)),
                            real_max(box_outside(yz), box_outside(xz)));
    real aside = outside + BOX_EDGE;
    real3 later = real3_scale(seen.later, aside);
    S(light_cover) found;
    found.distance =
        real_max(real_max(at.near.x - later.x, at.near.y - later.y), at.near.z - later.z);
    found.leaves = real_min(real_min(at.far.x + later.x, at.far.y + later.y), at.far.z + later.z);
    found.cover = real_all(0.0f);
    near = truth_and(near, light_is_behind(way, found));
    if (!real_some(near))
        return found;
    real of_yz = box_strip_cover(yz, near, way);
    near = truth_and(near, of_yz > 0.0f);
    if (!real_some(near))
        return found;
    real of_xz = box_strip_cover(xz, near, way);
    near = truth_and(near, of_xz > 0.0f);
    if (!real_some(near))
        return found;
    real of_xy = box_strip_cover(xy, near, way);
    found.cover = real_where(near, box_all(of_yz, of_xz, of_xy, seen.direction, near));
    return found;
}

/* A box is mostly much smaller than its bounding sphere: light may meet it where its ray meets the
 * box after this is grown by the cone. */
REAL_FN truth box_may_hide(S(kiln_draw_shape) s, S(box_seen) seen, real3 towards, S(light_way) way)
{
    real3 direction = seen.direction, inverse = seen.inverse;
    real3 to_box = shape_into(s, towards);
    real extent = box_extent(s.extent, direction);
    real grow = light_widest(way, real3_dot(to_box, direction) + extent) + 1e-3f;
    S(ray_slabs) at = box_slabs(to_box, s.extent, inverse);
    real3 more =
        REAL3(grow * real_abs(inverse.x), grow * real_abs(inverse.y), grow * real_abs(inverse.z));
    at.near = real3_sub(at.near, more);
    at.far = real3_add(at.far, more);
    S(ray_interval) grown = box_interval(at);
    return truth_and(truth_and(grown.near <= grown.far, grown.far >= -way.lit),
                     grown.near <= way.reach + way.radius);
}

/* Returns how far a point is outside of a box, m; 0 inside of it. */
REAL_FN real box_distance(float4 halves, real3 towards)
{
    real none = real_all(0.0f);
    return real3_length(REAL3(real_max(real_abs(towards.x) - halves.x, none),
                              real_max(real_abs(towards.y) - halves.y, none),
                              real_max(real_abs(towards.z) - halves.z, none)));
}

/* Returns where a block of a surface and the light are both beyond the side of a box along one
 * axis, which then hides nothing. The block may lie on this side. All numbers are along the axis;
 * to_light: the way to the light, m; size: of the block, m. */
REAL_FN truth box_is_beside(float halves, real towards, real to_light, real normal, real size)
{
    real margin = size * real_sqrt(real_max(1.0f - normal * normal, real_all(0.0f)));
    real least = margin + (halves - LIGHT_START), source = to_light - towards;
    return truth_or(truth_and(-towards >= least, source >= halves),
                    truth_and(towards >= least, -source >= halves));
}

REAL_FN truth box_is_smooth(S(kiln_draw_shape) s, real3 towards, S(light_way) way, real3 normal)
{
    real3 to_box = shape_into(s, towards), facing = shape_into(s, normal);
    real3 to_light = real3_scale(shape_into(s, way.direction), way.reach);
    truth blurred = light_blurs(way, box_distance(s.extent, to_box));
    blurred = truth_or(blurred, box_is_beside(s.extent.x, to_box.x, to_light.x, facing.x, way.lit));
    blurred = truth_or(blurred, box_is_beside(s.extent.y, to_box.y, to_light.y, facing.y, way.lit));
    return truth_or(blurred, box_is_beside(s.extent.z, to_box.z, to_light.z, facing.z, way.lit));
}

REAL_FN real box_sky(S(kiln_draw_shape) s, real3 towards, real3 normal)
{
    real3 to_box = shape_into(s, towards), facing = shape_into(s, normal);
    float size = exact_min(exact_min(s.extent.x, s.extent.y), s.extent.z);
    return sky_beside(to_box, facing, box_distance(s.extent, to_box), size,
                      box_extent(s.extent, facing));
}

/* ---- places ---------------------------------------------------------------------------------- */

FN float box_size(S(kiln_draw_shape) s)
{
    return SQRT(s.extent.x * s.extent.x + s.extent.y * s.extent.y + s.extent.z * s.extent.z);
}

REAL_FN truth box_contains(S(kiln_draw_shape) s, real3 from)
{
    real3 there = shape_into(s, from);
    return truth_and(truth_and(real_abs(there.x) < s.extent.x, real_abs(there.y) < s.extent.y),
                     real_abs(there.z) < s.extent.z);
}

REAL_FN real box_reach(S(kiln_draw_shape) s, real3 way)
{
    return box_extent(s.extent, shape_into(s, way));
}

#endif

/* ---- collision in its frame ------------------------------------------------------------------ */
#if defined(KILN_SHARED_COLLIDE_FRAME_H) && !defined(KILN_BOX_COLLIDES)
#define KILN_BOX_COLLIDES

FN S(collide_box) box_at(S(collide_frame) frame)
{
    EXACT S(collide_box) box;
    box.min = FLOAT3(-frame.extent.x, -frame.extent.y, -frame.extent.z);
    box.max = frame.extent;
    return box;
}

FN bool box_holds(S(collide_frame) frame, float3 q)
{
    EXACT S(collide_box) box = box_at(frame);
    bool within = collide_inside(box, q);
    return within;
}

FN S(collide_span) box_segment(S(collide_frame) start, S(collide_frame) end, float3 a, float3 b)
{
    EXACT S(collide_box) before = box_at(start);
    EXACT S(collide_box) after = box_at(end);
    EXACT S(collide_span) span = collide_segment(before, after, a, b);
    return span;
}

FN uint box_nearest(S(collide_frame) frame, float3 q)
{
    EXACT S(collide_box) box = box_at(frame);
    uint face = collide_nearest_face(box, q);
    return face;
}

FN float3 box_normal(S(collide_frame) frame, uint face, float3 q)
{
    EXACT float3 normal = FLOAT3(0.0f, 0.0f, 0.0f);
    EXACT float out_sign = (face & 1u) != 0u ? 1.0f : -1.0f;
    normal = collide_with_component(normal, face >> 1u, out_sign);
    return normal;
}

FN float3 box_put(S(collide_frame) frame, uint face, float3 q, float gap)
{
    uint axis = face >> 1u;
    EXACT float far = collide_component(frame.extent, axis) + gap;
    EXACT float at = (face & 1u) != 0u ? far : -far;
    EXACT float3 y = collide_with_component(q, axis, at);
    return y;
}

FN float3 box_grown(S(kiln_collider) c, S(collide_frame) frame, uint face, float3 normal, float3 q)
{
    EXACT float3 wider = FLOAT3(c.extent_end.x - c.extent.x, c.extent_end.y - c.extent.y,
                                c.extent_end.z - c.extent.z);
    EXACT float growth = collide_component(wider, face >> 1u);
    EXACT float3 grown = float3_scale(normal, growth);
    return grown;
}

#endif

/* NOLINTEND(misc-unused-parameters) */
