/* Draws planes and lets particles collide with the half spaces below them. A plane hides the same
 * part of a light from all places above it, so the host dims lights by planes, and the functions of
 * this file that say what a plane hides say that it is nothing. */
/* NOLINTBEGIN(misc-unused-parameters): all kinds have the same parameters */
#if defined(KILN_SHARED_SHAPE_H) && !defined(KILN_PLANE_DRAWN)
#define KILN_PLANE_DRAWN

REAL_FN S(ray_interval) plane_cross(S(kiln_draw_shape) s, S(shape_ray) ray)
{
    real height = -shape_along(s, real3_towards(s.center, ray.origin));
    return ray_interval_of(ray_cross_plane(height, shape_along(s, ray.direction)), real_all(2e9f));
}

REAL_FN S(shape_face) plane_face(S(kiln_draw_shape) s, S(shape_ray) ray, real t)
{
    S(shape_face) face;
    face.normal = real3_all(s.rows[1]);
    face.number = real_all(0.0f);
    return face;
}

struct plane_seen {
    real climb; /* cosine between its normal and the direction */
};

REAL_FN S(plane_seen) plane_seen_along(S(kiln_draw_shape) s, real3 direction)
{
    S(plane_seen) seen;
    seen.climb = shape_along(s, direction);
    return seen;
}

REAL_FN S(light_cover) plane_cover(S(kiln_draw_shape) s, S(plane_seen) seen, real3 towards,
                                   S(light_way) way, truth near)
{
    S(light_cover) found;
    found.cover = found.distance = found.leaves = real_all(0.0f);
    return found;
}

REAL_FN truth plane_may_hide(S(kiln_draw_shape) s, S(plane_seen) seen, real3 towards,
                             S(light_way) way)
{
    return way.reach < 0.0f;
}

REAL_FN truth plane_is_smooth(S(kiln_draw_shape) s, real3 towards, S(light_way) way, real3 normal)
{
    return way.reach > 0.0f;
}

REAL_FN real plane_sky(S(kiln_draw_shape) s, real3 towards, real3 normal)
{
    return real_all(1.0f);
}

FN float plane_size(S(kiln_draw_shape) s)
{
    return 1e9f;
}

REAL_FN truth plane_contains(S(kiln_draw_shape) s, real3 from)
{
    return shape_along(s, from) < 0.0f;
}

REAL_FN real plane_reach(S(kiln_draw_shape) s, real3 way)
{
    return real_all(1e9f);
}

/* Returns the part of a light that a plane hides from all places above it. height: of the light's
 * centre above the plane, m, or of a unit vector to the sun; radius: of the light, m, or the
 * tangent of the sun's. */
REAL_FN real plane_hides(real height, float radius)
{
    return disc_cover(-height / real_max(real_all(radius), real_all(1e-5f)));
}

#endif

/* ---- collision in its frame ------------------------------------------------------------------ */
#if defined(KILN_SHARED_COLLIDE_FRAME_H) && !defined(KILN_PLANE_COLLIDES)
#define KILN_PLANE_COLLIDES

FN bool plane_holds(S(collide_frame) frame, float3 q)
{
    return q.y < frame.extent.y;
}

FN S(collide_span) plane_segment(S(collide_frame) start, S(collide_frame) end, float3 a, float3 b)
{
    EXACT S(collide_span) span = collide_span_start();
    EXACT float depth0 = start.extent.y - a.y;
    EXACT float depth1 = end.extent.y - b.y;
    span = collide_face(span, COLLIDE_UPPER, depth0, depth1);
    return span;
}

FN uint plane_nearest(S(collide_frame) frame, float3 q)
{
    return COLLIDE_UPPER;
}

FN float3 plane_normal(S(collide_frame) frame, uint face, float3 q)
{
    EXACT float3 normal = collide_end_normal(COLLIDE_UPPER);
    return normal;
}

FN float3 plane_put(S(collide_frame) frame, uint face, float3 q, float gap)
{
    EXACT float3 y = collide_end_put(frame, COLLIDE_UPPER, q, gap);
    return y;
}

FN float3 plane_grown(S(kiln_collider) c, S(collide_frame) frame, uint face, float3 normal,
                      float3 q)
{
    EXACT float growth = collide_axis_growth(c);
    EXACT float3 grown = float3_scale(normal, growth);
    return grown;
}

#endif

/* NOLINTEND(misc-unused-parameters) */
