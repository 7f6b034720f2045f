/* Draws cylinders with flat ends, and lets particles collide with those whose axis turns
 * (collide_round.h has the others). */
/* NOLINTBEGIN(misc-unused-parameters): all kinds have the same parameters */
#if defined(KILN_SHARED_SHAPE_H) && !defined(KILN_CYLINDER_DRAWN)
#define KILN_CYLINDER_DRAWN

/* ---- rays ------------------------------------------------------------------------------------ */

REAL_FN S(ray_interval) cylinder_cross(S(kiln_draw_shape) s, S(shape_ray) ray)
{
    real3 towards = real3_towards(s.center, ray.origin);
    S(ray_interval) side = tube_cross(s, towards, ray.direction);
    S(ray_interval) ends = ends_cross(s, towards, ray.direction);
    truth hits = side.near <= side.far;
    return ray_interval_of(real_max(side.near, ends.near),
                           real_select(hits, real_min(side.far, ends.far), real_all(-1e9f)));
}

REAL_FN S(shape_face) cylinder_face(S(kiln_draw_shape) s, S(shape_ray) ray, real t)
{
    real3 towards = real3_towards(s.center, ray.origin);
    truth on_end =
        ends_cross(s, towards, ray.direction).near > tube_cross(s, towards, ray.direction).near;
    real3 from = real3_sub(real3_add_scaled(ray.origin, ray.direction, t), real3_all(s.center));
    real height = shape_along(s, from);
    real3 side = real3_normalize(shape_across(s, from, height));
    real3 end = real3_scale(real3_all(s.rows[1]), real_sign_one(height));
    S(shape_face) face;
    face.normal = real3_select(on_end, end, side);
    face.number = real_where(on_end, real_select(height > 0.0f, real_all(1.0f), real_all(2.0f)));
    return face;
}

/* ---- light ----------------------------------------------------------------------------------- */

/* A cylinder as seen in a direction: a band along `up`, with round ends. */
struct cylinder_seen {
    S(axis_seen) axis;
};

REAL_FN S(cylinder_seen) cylinder_seen_along(S(kiln_draw_shape) s, real3 direction)
{
    S(cylinder_seen) seen;
    seen.axis = axis_seen_along(s, direction);
    return seen;
}

/* The light's ray, its start moved to the nearest place inside of the outline, leaves the cylinder
 * through its side or its end. */
REAL_FN S(light_cover) cylinder_cover(S(kiln_draw_shape) s, S(cylinder_seen) seen, real3 towards,
                                      S(light_way) way, truth near)
{
    S(axis_seen) axis = seen.axis;
    float radius = s.extent.w, half_height = s.extent.y;
    real x = real3_dot(towards, axis.right), y = real3_dot(towards, axis.up);
    real ahead = real3_dot(towards, way.direction);
    real along = real_clamp(-y * (1.0f / (axis.slant * axis.side)), -half_height, half_height);
    real t = real_max(ahead + along * axis.climb, real_all(0.0f));
    real inside = real_sqrt(real_max(radius * radius - x * x, real_all(0.0f)));
    real end = half_height * axis.slant + real_abs(axis.climb) * inside;
    real disc = light_disc(way, t);
    real sides = strip_cover(radius - real_abs(x), radius + real_abs(x), disc);
    real ends = strip_cover(end - real_abs(y), end + real_abs(y), disc);
    real at = real_max(-end, real_min(y, end)) * axis.side;
    real height = -ahead * axis.climb - at * axis.slant; /* of the start above the middle */
    real beside = -ahead * axis.slant + at * axis.climb; /* from the axis, towards the light */
    real falls = real_sign_one(axis.climb);
    real steep = falls * real_max(real_abs(axis.climb), real_all(1e-6f));
    S(light_cover) found;
    found.cover = sides * ends;
    found.distance = t;
    found.leaves = real_min((inside - beside) / axis.slant, (falls * half_height - height) / steep);
    return found;
}

/* Returns where a cylinder may hide a light: not where a point or ball lies wholly beyond an end or
 * beside the cylinder, with the light on the same side. */
REAL_FN truth cylinder_may_hide(S(kiln_draw_shape) s, S(cylinder_seen) seen, real3 towards,
                                S(light_way) way)
{
    S(axis_seen) axis = seen.axis;
    float radius = s.extent.w;
    real climb = axis.climb, height = -shape_along(s, towards);
    real3 aside = shape_across(s, towards, -height);
    truth beyond = truth_and(height * climb > 0.0f, real_abs(height) - s.extent.y > way.lit);
    truth beside = truth_and(real3_length(aside) - radius > way.lit,
                             -real3_dot(aside, way.direction) > way.lit);
    return truth_and(axis_may_hide(s, towards, way, climb, real3_scale(axis.right, axis.slant),
                                   axis.slant * axis.slant),
                     truth_not(truth_or(beyond, beside)));
}

/* Returns how far a point is outside of a cylinder, m; 0 inside of it. */
REAL_FN real cylinder_distance(S(kiln_draw_shape) s, real3 towards)
{
    real along = shape_along(s, towards);
    real above = real_max(real_abs(along) - s.extent.y, real_all(0.0f));
    real beside =
        real_max(real3_length(shape_across(s, towards, along)) - s.extent.w, real_all(0.0f));
    return real_sqrt(above * above + beside * beside);
}

REAL_FN truth cylinder_is_smooth(S(kiln_draw_shape) s, real3 towards, S(light_way) way,
                                 real3 normal)
{
    return light_blurs(way, cylinder_distance(s, towards));
}

/* ---- places ---------------------------------------------------------------------------------- */

FN float cylinder_size(S(kiln_draw_shape) s)
{
    return SQRT(s.extent.w * s.extent.w + s.extent.y * s.extent.y);
}

REAL_FN truth cylinder_contains(S(kiln_draw_shape) s, real3 from)
{
    real height = shape_along(s, from);
    real3 aside = shape_across(s, from, height);
    return truth_and(real_abs(height) < s.extent.y,
                     real3_dot(aside, aside) < s.extent.w * s.extent.w);
}

REAL_FN real cylinder_reach(S(kiln_draw_shape) s, real3 way)
{
    real climb = shape_along(s, way);
    return s.extent.y * real_abs(climb) + disc_reach(s.extent.w, climb);
}

REAL_FN real cylinder_sky(S(kiln_draw_shape) s, real3 towards, real3 normal)
{
    return sky_beside(towards, normal, cylinder_distance(s, towards),
                      exact_min(s.extent.y, s.extent.w), cylinder_reach(s, normal));
}

#endif

/* ---- collision in its frame ------------------------------------------------------------------ */
#if defined(KILN_SHARED_COLLIDE_FRAME_H) && !defined(KILN_CYLINDER_COLLIDES)
#define KILN_CYLINDER_COLLIDES

FN bool cylinder_holds(S(collide_frame) frame, float3 q)
{
    EXACT float3 across = collide_from_axis(q);
    EXACT float excess = collide_round_excess(across, frame.radius);
    return excess < 0.0f && q.y < frame.extent.y && -q.y < frame.extent.y;
}

FN S(collide_span) cylinder_segment(S(collide_frame) start, S(collide_frame) end, float3 a,
                                    float3 b)
{
    EXACT S(collide_span) span = collide_barrel(start, end, a, b);
    return span;
}

FN uint cylinder_nearest(S(collide_frame) frame, float3 q)
{
    EXACT float3 across = collide_from_axis(q);
    EXACT float aside = float3_length(across);
    EXACT float side = frame.radius - aside;
    return collide_nearest_of(side, frame.extent.y, q);
}

FN float3 cylinder_normal(S(collide_frame) frame, uint face, float3 q)
{
    EXACT float3 across = collide_from_axis(q);
    EXACT float3 normal = collide_side_normal(across);
    if (face != COLLIDE_SIDE)
        normal = collide_end_normal(face);
    return normal;
}

FN float3 cylinder_put(S(collide_frame) frame, uint face, float3 q, float gap)
{
    EXACT float3 across = collide_from_axis(q);
    EXACT float3 y = collide_side_put(frame, across, q, gap);
    if (face != COLLIDE_SIDE)
        y = collide_end_put(frame, face, q, gap);
    return y;
}

FN float3 cylinder_grown(S(kiln_collider) c, S(collide_frame) frame, uint face, float3 normal,
                         float3 q)
{
    EXACT float growth = collide_radius_growth(c);
    if (face != COLLIDE_SIDE)
        growth = collide_axis_growth(c);
    EXACT float3 grown = float3_scale(normal, growth);
    return grown;
}

#endif

/* NOLINTEND(misc-unused-parameters) */
