/* Draws capsules and lets particles collide with them. A capsule is all balls of one radius whose
 * centres lie on a segment. A ball is drawn as a capsule whose segment has no length. */
/* NOLINTBEGIN(misc-unused-parameters): all kinds have the same parameters */
#if defined(KILN_SHARED_SHAPE_H) && !defined(KILN_CAPSULE_DRAWN)
#define KILN_CAPSULE_DRAWN

/* ---- rays ------------------------------------------------------------------------------------ */

/* Intersects a ball. The discriminant is taken from the vector across the ray, which stays precise
 * far away. */
REAL_FN S(ray_interval) ball_cross(real3 towards, float radius, real3 direction)
{
    real a = 1.0f / real3_dot(direction, direction);
    real middle = real3_dot(towards, direction) * a;
    real3 across = real3_add_scaled(towards, direction, -middle);
    real inside = (radius * radius - real3_dot(across, across)) * a;
    real extent = real_sqrt(real_max(inside, real_all(0.0f)));
    return ray_interval_or_miss(inside > 0.0f, middle - extent, middle + extent);
}

/* Returns the interval of two convex shapes whose union is convex. */
REAL_FN S(ray_interval) ray_either(S(ray_interval) a, S(ray_interval) b)
{
    truth has_a = a.near <= a.far, has_b = b.near <= b.far;
    real near = real_min(real_select(has_a, a.near, b.near), real_select(has_b, b.near, a.near));
    real far = real_max(real_select(has_a, a.far, b.far), real_select(has_b, b.far, a.far));
    return ray_interval_or_miss(truth_or(has_a, has_b), near, far);
}

REAL_FN S(ray_interval) capsule_cross(S(kiln_draw_shape) s, S(shape_ray) ray)
{
    real3 towards = real3_towards(s.center, ray.origin), axis = real3_all(s.rows[1]);
    real half_height = real_all(s.extent.y);
    S(ray_interval) low =
        ball_cross(real3_add_scaled(towards, axis, -half_height), s.extent.w, ray.direction);
#ifndef GL_core_profile
    if (s.extent.y == 0.0f)
        return low;
#endif
    S(ray_interval) high =
        ball_cross(real3_add_scaled(towards, axis, half_height), s.extent.w, ray.direction);
    S(ray_interval) side = tube_cross(s, towards, ray.direction);
    S(ray_interval) ends = ends_cross(s, towards, ray.direction);
    side = ray_interval_or_miss(side.near <= side.far, real_max(side.near, ends.near),
                                real_min(side.far, ends.far));
    return ray_either(side, ray_either(low, high));
}

/* Returns the way from the centre of the nearest ball of a capsule. from: the way from the centre
 * of the capsule. */
REAL_FN real3 capsule_across(S(kiln_draw_shape) s, real3 from)
{
    return shape_across(s, from, real_clamp(shape_along(s, from), -s.extent.y, s.extent.y));
}

REAL_FN S(shape_face) capsule_face(S(kiln_draw_shape) s, S(shape_ray) ray, real t)
{
    real3 from = real3_sub(real3_add_scaled(ray.origin, ray.direction, t), real3_all(s.center));
    S(shape_face) face;
    face.normal = real3_normalize(capsule_across(s, from));
    face.number = real_all(0.0f);
    return face;
}

/* ---- light ----------------------------------------------------------------------------------- */

/* A capsule as seen in a direction. */
struct capsule_seen {
    real climb;   /* cosine between the axis and the direction */
    real3 level;  /* the axis without its part along the direction */
    real3 across; /* across the axis and the direction, as long as `level` */
    real square;  /* of that length */
};

REAL_FN S(capsule_seen) capsule_seen_along(S(kiln_draw_shape) s, real3 direction)
{
    real3 axis = real3_all(s.rows[1]);
    S(capsule_seen) seen;
    seen.climb = shape_along(s, direction);
    seen.level = real3_add_scaled(axis, direction, -seen.climb);
    seen.across = real3_cross(axis, direction);
    seen.square = real3_dot(seen.level, seen.level);
    return seen;
}

/* Light passes most closely by one of the balls that form a capsule. A ball that is smaller than
 * the disc of light hides no more than its share. */
REAL_FN S(light_cover) capsule_cover(S(kiln_draw_shape) s, S(capsule_seen) seen, real3 towards,
                                     S(light_way) way, truth near)
{
    float radius = s.extent.w;
    real along = real3_dot(towards, seen.level) * (-1.0f / real_max(seen.square, real_all(1e-6f)));
    real3 ball =
        real3_add_scaled(towards, real3_all(s.rows[1]), real_clamp(along, -s.extent.y, s.extent.y));
    real t = real3_dot(ball, way.direction);
    real3 aside = real3_add_scaled(ball, way.direction, -t);
    real square = real3_dot(aside, aside), across = real_sqrt(square);
    real disc = light_disc(way, t);
    S(light_cover) found;
    found.cover = strip_cover(radius - across, radius + across, disc) *
                  real_min(radius / disc, real_all(1.0f));
    found.distance = t;
    found.leaves = t + real_sqrt(real_max(radius * radius - square, real_all(0.0f)));
    return found;
}

REAL_FN truth capsule_may_hide(S(kiln_draw_shape) s, S(capsule_seen) seen, real3 towards,
                               S(light_way) way)
{
#ifndef GL_core_profile
    if (s.extent.y == 0.0f) /* a ball is its own bounding sphere */
        return way.reach > 0.0f;
#endif
    return axis_may_hide(s, towards, way, seen.climb, seen.across, seen.square);
}

REAL_FN truth capsule_is_smooth(S(kiln_draw_shape) s, real3 towards, S(light_way) way, real3 normal)
{
    return light_blurs(
        way, real_max(real3_length(capsule_across(s, towards)) - s.extent.w, real_all(0.0f)));
}

/* A capsule hides as much of the sky as the nearest of its balls. */
REAL_FN real capsule_sky(S(kiln_draw_shape) s, real3 towards, real3 normal)
{
    real3 ball = capsule_across(s, towards);
    real distance2 = real_max(real3_dot(ball, ball), real_all(1e-9f));
    real fall = real_min(s.extent.w * s.extent.w / distance2, real_all(1.0f));
    return sky_left(sky_facing(real3_dot(ball, normal), distance2), fall);
}

/* ---- places ---------------------------------------------------------------------------------- */

FN float capsule_size(S(kiln_draw_shape) s)
{
    return s.extent.w + s.extent.y;
}

REAL_FN truth capsule_contains(S(kiln_draw_shape) s, real3 from)
{
    real3 across = capsule_across(s, from);
    return real3_dot(across, across) < s.extent.w * s.extent.w;
}

REAL_FN real capsule_reach(S(kiln_draw_shape) s, real3 way)
{
    return s.extent.w + s.extent.y * real_abs(shape_along(s, way));
}

#endif

/* ---- collision in its frame ------------------------------------------------------------------ */
#if defined(KILN_SHARED_COLLIDE_FRAME_H) && !defined(KILN_CAPSULE_COLLIDES)
#define KILN_CAPSULE_COLLIDES

/* Returns the vector from the nearest centre of its balls. */
FN float3 capsule_from_axis(S(collide_frame) frame, float3 q)
{
    EXACT float low = -frame.extent.y;
    EXACT float foot = exact_clamp(q.y, low, frame.extent.y);
    EXACT float beyond = q.y - foot;
    EXACT float3 y = FLOAT3(q.x, beyond, q.z);
    return y;
}

FN bool capsule_holds(S(collide_frame) frame, float3 q)
{
    EXACT float3 across = capsule_from_axis(frame, q);
    EXACT float excess = collide_round_excess(across, frame.radius);
    return excess < 0.0f;
}

/* Intersects a segment with the ball at one of the ends. */
FN S(collide_span) capsule_end(S(collide_frame) start, S(collide_frame) end, float3 a, float3 b,
                               float upwards)
{
    EXACT S(collide_span) span = collide_span_start();
    EXACT float3 from = FLOAT3(a.x, a.y - upwards * start.extent.y, a.z);
    EXACT float3 to = FLOAT3(b.x, b.y - upwards * end.extent.y, b.z);
    span = collide_side(span, from, to, start.radius, end.radius);
    return span;
}

FN S(collide_span) capsule_segment(S(collide_frame) start, S(collide_frame) end, float3 a, float3 b)
{
    EXACT S(collide_span) span = collide_barrel(start, end, a, b);
    EXACT S(collide_span) low = capsule_end(start, end, a, b, -1.0f);
    EXACT S(collide_span) high = capsule_end(start, end, a, b, 1.0f);
    EXACT S(collide_span) balls = collide_either(low, high);
    span = collide_either(span, balls);
    span.face = COLLIDE_SIDE;
    return span;
}

FN uint capsule_nearest(S(collide_frame) frame, float3 q)
{
    return COLLIDE_SIDE;
}

FN float3 capsule_normal(S(collide_frame) frame, uint face, float3 q)
{
    EXACT float3 across = capsule_from_axis(frame, q);
    EXACT float3 normal = collide_side_normal(across);
    return normal;
}

FN float3 capsule_put(S(collide_frame) frame, uint face, float3 q, float gap)
{
    EXACT float3 across = capsule_from_axis(frame, q);
    EXACT float3 y = collide_side_put(frame, across, q, gap);
    return y;
}

/* The ends of a growing capsule move apart. */
FN float3 capsule_grown(S(kiln_collider) c, S(collide_frame) frame, uint face, float3 normal,
                        float3 q)
{
    EXACT float growth = collide_radius_growth(c);
    EXACT float3 grown = float3_scale(normal, growth);
    EXACT float longer = collide_axis_growth(c);
    EXACT float beyond = exact_abs(q.y) - frame.extent.y;
    EXACT float apart = q.y < 0.0f ? -longer : longer;
    grown.y = grown.y + (beyond > 0.0f ? apart : 0.0f);
    return grown;
}

#endif

/* NOLINTEND(misc-unused-parameters) */
