/* Intersects segments with spheres and capped cylinders, for shared/collide.h.
 *
 * Centre, radius and height change evenly during the step. With q(t) the vector from the centre
 * (for a cylinder, from the axis) to the particle, |q(t)|^2 - r(t)^2 is a quadratic in the part t
 * of the path. Its roots are where the path enters and leaves. A cylinder is the intersection of a
 * round side and two faces, just as a box is the intersection of six faces. */
#ifndef KILN_SHARED_COLLIDE_ROUND_H
#define KILN_SHARED_COLLIDE_ROUND_H

#include "shared/collide_box.h"

/* Faces of round shapes, numbered after those of boxes. */
#define COLLIDE_SIDE  6u
#define COLLIDE_LOWER 7u /* the end at the start of the axis */
#define COLLIDE_UPPER 8u

struct collide_round {
    float3 center;
    float3 axis;
    float radius;
    float half_height;
};

/* Returns the shape after the part `since` of the step. */
FN S(collide_round) collide_round_at(S(kiln_collider) c, float since)
{
    EXACT S(collide_round) shape;
    shape.center = collide_moving3(c.center, c.center_end, since);
    shape.axis = FLOAT3(c.axis.x, c.axis.y, c.axis.z);
    shape.radius = collide_moving(c.center.w, c.center_end.w, since);
    shape.half_height = collide_moving(c.axis.w, c.half_height_end, since);
    return shape;
}

/* A point relative to the centre, split across and along the axis. */
struct collide_place {
    float3 across; /* for a sphere, the whole vector */
    float height;
};

FN S(collide_place) collide_round_place(uint kind, S(collide_round) shape, float3 p)
{
    EXACT S(collide_place) place;
    EXACT float3 from = float3_sub(p, shape.center);
    place.across = from;
    place.height = 0.0f;
    if (kind == COLLIDER_CYLINDER) {
        place.height = float3_dot(from, shape.axis);
        EXACT float down = -place.height;
        place.across = float3_add_scaled(from, shape.axis, down);
    }
    return place;
}

/* Returns |across|^2 - radius^2, which is below 0 inside. */
FN float collide_round_excess(float3 across, float radius)
{
    EXACT float square = float3_dot(across, across);
    EXACT float limit = radius * radius;
    EXACT float excess = square - limit;
    EXACT float y = exact_canon(excess);
    return y;
}

FN bool collide_round_inside(uint kind, S(collide_round) shape, float3 p)
{
    EXACT S(collide_place) place = collide_round_place(kind, shape, p);
    EXACT float excess = collide_round_excess(place.across, shape.radius);
    bool between = kind != COLLIDER_CYLINDER ||
                   (place.height < shape.half_height && -place.height < shape.half_height);
    return excess < 0.0f && between;
}

/* Adds the round side as one more face to a result, for a segment from a with radius r0 to b with
 * radius r1. Most ways miss it, which is known before roots are computed. */
FN_CLOSE S(collide_span) collide_side(S(collide_span) before, float3 a, float3 b, float r0,
                                      float r1)
{
    EXACT S(collide_span) span = before;
    EXACT float3 way = float3_sub(b, a);
    EXACT float growth = r1 - r0;
    EXACT float way2 = float3_dot(way, way);
    EXACT float growth2 = growth * growth;
    EXACT float slope = float3_dot(a, way);
    EXACT float widening = r0 * growth;
    EXACT float square_term = way2 - growth2;
    square_term = exact_canon(square_term);
    EXACT float linear_term = slope - widening;
    linear_term = exact_canon(linear_term);
    EXACT float at_start = collide_round_excess(a, r0);
    EXACT float at_end = collide_round_excess(b, r1);
    EXACT float linear2 = linear_term * linear_term;
    EXACT float product = square_term * at_start;
    EXACT float discriminant = linear2 - product;
    discriminant = exact_canon(discriminant);

    bool in0 = at_start < 0.0f;
    bool in1 = at_end < 0.0f;
    bool crosses = discriminant > 0.0f && linear_term < 0.0f && square_term > 0.0f &&
                   -linear_term < square_term;
    span.misses = span.misses || (!in0 && !in1 && !crosses);
    span.outside = span.outside || !in0;
    if (span.misses)
        return span;
    EXACT float root = exact_sqrt(discriminant);
    EXACT float divisor = root - linear_term;
    EXACT float first = exact_div(at_start, divisor);
    EXACT float last = exact_div(divisor, square_term);
    first = exact_clamp(first, 0.0f, 1.0f);
    last = exact_clamp(last, 0.0f, 1.0f);
    if (!in0 && first >= span.enter) {
        span.enter = first;
        span.face = COLLIDE_SIDE;
    }
    if (!in1)
        span.leave = exact_min(span.leave, last);
    return span;
}

FN_CLOSE S(collide_span) collide_round_segment(uint kind, S(collide_round) start,
                                               S(collide_round) end, float3 a, float3 b)
{
    EXACT S(collide_span) span;
    span.enter = 0.0f;
    span.leave = 2.0f;
    span.face = COLLIDE_SIDE;
    span.misses = false;
    span.outside = false;
    EXACT S(collide_place) p0 = collide_round_place(kind, start, a);
    EXACT S(collide_place) p1 = collide_round_place(kind, end, b);
    EXACT float lower0 = start.half_height + p0.height;
    EXACT float lower1 = end.half_height + p1.height;
    EXACT float upper0 = start.half_height - p0.height;
    EXACT float upper1 = end.half_height - p1.height;
    if (kind == COLLIDER_CYLINDER) {
        bool below = !(lower0 > 0.0f) && !(lower1 > 0.0f);
        bool above = !(upper0 > 0.0f) && !(upper1 > 0.0f);
        span.misses = below || above;
    }
    if (span.misses)
        return span;
    span = collide_side(span, p0.across, p1.across, start.radius, end.radius);
    if (kind == COLLIDER_CYLINDER && !span.misses) {
        span = collide_face(span, COLLIDE_LOWER, lower0, lower1);
        span = collide_face(span, COLLIDE_UPPER, upper0, upper1);
    }
    return span;
}

/* Returns the part of the surface that a point inside is nearest to. */
FN uint collide_round_nearest(uint kind, S(collide_round) shape, float3 p)
{
    uint face = COLLIDE_SIDE;
    if (kind == COLLIDER_CYLINDER) {
        EXACT S(collide_place) place = collide_round_place(kind, shape, p);
        EXACT float aside = float3_length(place.across);
        EXACT float least = shape.radius - aside;
        EXACT float lower = shape.half_height + place.height;
        EXACT float upper = shape.half_height - place.height;
        face = lower < least ? COLLIDE_LOWER : face;
        least = exact_min(lower, least);
        face = upper < least ? COLLIDE_UPPER : face;
    }
    return face;
}

/* Returns the outward normal at a point near the surface. At a point on the axis it is up, or some
 * direction across the axis. */
FN_CLOSE float3 collide_round_normal(uint kind, S(collide_round) shape, uint face, float3 p)
{
    EXACT float3 back = float3_scale(shape.axis, -1.0f);
    if (face == COLLIDE_LOWER)
        return back;
    if (face == COLLIDE_UPPER)
        return shape.axis;
    EXACT S(collide_place) place = collide_round_place(kind, shape, p);
    EXACT float3 otherwise = FLOAT3(0.0f, 1.0f, 0.0f);
    if (kind == COLLIDER_CYLINDER) {
        EXACT float steep = exact_abs(shape.axis.y);
        EXACT float3 other = FLOAT3(1.0f, 0.0f, 0.0f);
        if (steep < 0.5f)
            other = otherwise;
        EXACT float3 aside = float3_cross(shape.axis, other);
        otherwise = float3_normalize(aside, other);
    }
    EXACT float3 y = float3_normalize(place.across, otherwise);
    return y;
}

/* Packs a direction into 3 x 10 bits, with a mark that no number of a face has. */
FN uint collide_pack_normal(float3 normal)
{
    EXACT float x = normal.x * 511.0f + 512.5f;
    EXACT float y = normal.y * 511.0f + 512.5f;
    EXACT float z = normal.z * 511.0f + 512.5f;
    x = exact_clamp(x, 0.0f, 1023.0f);
    y = exact_clamp(y, 0.0f, 1023.0f);
    z = exact_clamp(z, 0.0f, 1023.0f);
    return 0x80000000u | (UINT(x) << 20u) | (UINT(y) << 10u) | UINT(z);
}

FN float3 collide_unpack_normal(uint bits)
{
    EXACT float x = FLOAT((bits >> 20u) & 1023u) - 512.0f;
    EXACT float y = FLOAT((bits >> 10u) & 1023u) - 512.0f;
    EXACT float z = FLOAT(bits & 1023u) - 512.0f;
    EXACT float3 direction = FLOAT3(x, y, z);
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 unit = float3_normalize(direction, up);
    return unit;
}

/* Returns the point of the surface nearest to p, moved outwards by `gap`. */
FN float3 collide_round_put(uint kind, S(collide_round) shape, uint face, float3 p, float gap)
{
    EXACT S(collide_place) place = collide_round_place(kind, shape, p);
    EXACT float3 normal = collide_round_normal(kind, shape, face, p);
    EXACT float3 along = float3_scale(shape.axis, place.height);
    EXACT float3 foot = float3_add(shape.center, along);
    EXACT float far = shape.radius + gap;
    if (face != COLLIDE_SIDE) {
        foot = float3_add(shape.center, place.across);
        far = shape.half_height + gap;
    }
    EXACT float3 y = float3_add_scaled(foot, normal, far);
    return y;
}

/* Returns the gap, as collide_beside does, for the lengths from which a place on the surface is
 * computed. */
FN float collide_round_gap(S(collide_round) shape)
{
    EXACT float x = exact_abs(shape.center.x);
    EXACT float y = exact_abs(shape.center.y);
    EXACT float z = exact_abs(shape.center.z);
    EXACT float reach = x + y + z + shape.radius + shape.half_height;
    EXACT float least = collide_least_gap(shape.radius);
    EXACT float gap = least + reach * 4.76837158203125e-7f;
    return gap;
}

/* Returns the velocity of the surface where it has this normal, m/s. */
FN float3 collide_round_velocity(S(kiln_collider) c, uint face, float3 normal, float steps_per_s)
{
    EXACT float3 motion = FLOAT3(c.center_end.x - c.center.x, c.center_end.y - c.center.y,
                                 c.center_end.z - c.center.z);
    EXACT float growth =
        face == COLLIDE_SIDE ? c.center_end.w - c.center.w : c.half_height_end - c.axis.w;
    motion = float3_add_scaled(motion, normal, growth);
    EXACT float3 y = float3_scale(motion, steps_per_s);
    return y;
}

#endif
