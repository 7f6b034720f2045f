/* Draws cones with a flat base and lets particles collide with them. The centre is halfway between
 * the base, where the radius is the whole one, and the tip, which the axis points to. */
/* NOLINTBEGIN(misc-unused-parameters): all kinds have the same parameters */
#if defined(KILN_SHARED_SHAPE_H) && !defined(KILN_CONE_DRAWN)
#define KILN_CONE_DRAWN

/* ---- rays ------------------------------------------------------------------------------------ */

/* How much the radius of a cone shrinks for each metre towards its tip. */
FN float cone_slope(S(kiln_draw_shape) s)
{
    return s.extent.w / (2.0f * s.extent.y);
}

/* Returns the t at which a ray enters and leaves the cone above its base, as if it were infinitely
 * long. Lines also meet the cone's mirror image beyond the tip: a flat ray meets one of the two, a
 * steep ray, which `steep` says, both. The ray starts anew where it is nearest to the centre, so
 * that the roots stay precise far away. */
REAL_FN S(ray_interval) cone_side(S(kiln_draw_shape) s, real3 towards, real3 direction)
{
    float k = cone_slope(s);
    real start = real3_dot(towards, direction) / real3_dot(direction, direction);
    real3 from = real3_add_scaled(real3_scale(towards, real_all(-1.0f)), direction, start);
    real height = shape_along(s, from), climb = shape_along(s, direction);
    real3 p = shape_across(s, from, height), d = shape_across(s, direction, climb);
    real width = k * (s.extent.y - height), narrowing = k * climb;
    real square = real3_dot(d, d) - narrowing * narrowing;
    real linear = real3_dot(p, d) + width * narrowing;
    real rest = real3_dot(p, p) - width * width;
    real discriminant = linear * linear - square * rest;
    real root = real_sqrt(real_max(discriminant, real_all(0.0f)));
    real scale = real_sign_one(square) / real_max(real_abs(square), real_all(1e-9f));
    real one = (-linear - root) * scale, other = (-linear + root) * scale;
    real low = real_min(one, other), high = real_max(one, other), middle = -linear * scale;
    truth steep = square<0.0f, rises = climb> 0.0f;
    truth hits = truth_and(discriminant > 0.0f, width - narrowing * middle > 0.0f);
    real flat_near = real_select(hits, low, real_all(1.0f));
    real flat_far = real_select(hits, high, real_all(-1.0f));
    real near = real_select(steep, real_select(rises, real_all(-1e9f), high), flat_near);
    real far = real_select(steep, real_select(rises, low, real_all(1e9f)), flat_far);
    return ray_interval_of(near + start, far + start);
}

/* Returns the t at which a ray crosses the plane of the base. */
REAL_FN real cone_base(S(kiln_draw_shape) s, real3 towards, real3 direction)
{
    return (shape_along(s, towards) - s.extent.y) * ray_inverse(shape_along(s, direction));
}

REAL_FN S(ray_interval) cone_cross(S(kiln_draw_shape) s, S(shape_ray) ray)
{
    real3 towards = real3_towards(s.center, ray.origin);
    S(ray_interval) side = cone_side(s, towards, ray.direction);
    real base = cone_base(s, towards, ray.direction);
    truth rises = shape_along(s, ray.direction) >= 0.0f;
    return ray_interval_of(real_select(rises, real_max(side.near, base), side.near),
                           real_select(rises, side.far, real_min(side.far, base)));
}

/* Returns the outward normal of the side at a place, which is `from` the centre. */
REAL_FN real3 cone_side_normal(S(kiln_draw_shape) s, real3 from)
{
    real3 across = shape_across(s, from, shape_along(s, from));
    real3 outwards =
        real3_scale(across, real_rsqrt(real_max(real3_dot(across, across), real_all(1e-12f))));
    return real3_normalize(
        real3_add_scaled(outwards, real3_all(s.rows[1]), real_all(cone_slope(s))));
}

REAL_FN S(shape_face) cone_face(S(kiln_draw_shape) s, S(shape_ray) ray, real t)
{
    real3 towards = real3_towards(s.center, ray.origin), axis = real3_all(s.rows[1]);
    truth on_base = truth_and(shape_along(s, ray.direction) >= 0.0f,
                              cone_base(s, towards, ray.direction) >= t * (1.0f - 1e-6f));
    real3 from = real3_sub(real3_scale(ray.direction, t), towards);
    S(shape_face) face;
    face.normal =
        real3_select(on_base, real3_scale(axis, real_all(-1.0f)), cone_side_normal(s, from));
    face.number = real_where(on_base, real_all(1.0f));
    return face;
}

/* ---- light ----------------------------------------------------------------------------------- */

/* A cone as seen in a direction: an ellipse, the base, and a tip on the line of `up`. Two lines
 * lead from the tip along the ellipse, unless the tip is seen in front of the base or behind it. */
struct cone_seen {
    S(axis_seen) axis;
    real aside, upward; /* the outward normal of the line at the right; 0 and 0 without lines */
};

REAL_FN S(cone_seen) cone_seen_along(S(kiln_draw_shape) s, real3 direction)
{
    S(cone_seen) seen;
    seen.axis = axis_seen_along(s, direction);
    real tall = 2.0f * s.extent.y * seen.axis.slant, deep = s.extent.w * seen.axis.climb;
    real beyond = tall * tall - deep * deep; /* by how far the tip is beyond the ellipse, squared */
    real scale = real_rsqrt(real_max(beyond, real_all(0.0f)) + s.extent.w * s.extent.w);
    seen.aside = real_where(beyond > 0.0f, real_sqrt(real_max(beyond, real_all(0.0f))) * scale);
    seen.upward = real_where(beyond > 0.0f, s.extent.w * scale);
    return seen;
}

/* Returns how far a way goes until it leaves the half space inside of a face, m. inside: distance
 * of its start from the face, m; rate: cosine between the face's normal and the way. */
REAL_FN real cone_leaves(real inside, real rate)
{
    return real_select(rate > 0.0f, inside / real_max(rate, real_all(1e-6f)), real_all(1e9f));
}

REAL_FN S(light_cover) cone_cover(S(kiln_draw_shape) s, S(cone_seen) seen, real3 towards,
                                  S(light_way) way, truth near)
{
    float radius = s.extent.w, half_height = s.extent.y;
    real x = real_abs(real3_dot(towards, seen.axis.right)),
         y = -real3_dot(towards, seen.axis.up) * seen.axis.side;
    real ahead = real3_dot(towards, way.direction);
    real along = real_clamp(-shape_along(s, towards), -half_height, half_height);
    real t = real_max(ahead + along * seen.axis.climb, real_all(0.0f)), disc = light_disc(way, t);
    real inside = real_sqrt(real_max(radius * radius - x * x, real_all(0.0f)));
    real bulge = real_abs(seen.axis.climb) * inside, middle = half_height * seen.axis.slant;
    truth has_lines = seen.aside > 0.0f;
    real far = real_all(1e6f);
    real below = seen.upward * (middle - y);
    real one = real_min(radius - x, real_select(has_lines, below - seen.aside * x, far));
    real other = real_min(radius + x, real_select(has_lines, below + seen.aside * x, far));
    real top = real_select(has_lines, far, bulge - middle - y);

    real3 from = real3_scale(towards, real_all(-1.0f));
    real height = shape_along(s, from), climb = shape_along(s, way.direction);
    real3 normal = cone_side_normal(s, from);
    real narrow = real_rsqrt(real_all(1.0f + cone_slope(s) * cone_slope(s)));
    real width = cone_slope(s) * (half_height - height);
    real within = (width - real3_length(shape_across(s, from, height))) * narrow;
    S(light_cover) found;
    found.cover = strip_cover(one, other, disc) * strip_cover(y + middle + bulge, top, disc);
    found.distance = t;
    found.leaves = real_min(cone_leaves(within, real3_dot(normal, way.direction)),
                            cone_leaves(half_height + height, -climb));
    return found;
}

REAL_FN truth cone_may_hide(S(kiln_draw_shape) s, S(cone_seen) seen, real3 towards,
                            S(light_way) way)
{
    return axis_may_hide(s, towards, way, seen.axis.climb,
                         real3_scale(seen.axis.right, seen.axis.slant),
                         seen.axis.slant * seen.axis.slant);
}

/* Returns a distance that a point is outside of a cone at least, m; 0 inside of it. */
REAL_FN real cone_distance(S(kiln_draw_shape) s, real3 towards)
{
    real height = -shape_along(s, towards);
    real aside = real3_length(shape_across(s, towards, -height));
    real narrow = real_rsqrt(real_all(1.0f + cone_slope(s) * cone_slope(s)));
    real beside = (aside - cone_slope(s) * (s.extent.y - height)) * narrow;
    return real_max(real_max(beside, -s.extent.y - height), real_all(0.0f));
}

REAL_FN truth cone_is_smooth(S(kiln_draw_shape) s, real3 towards, S(light_way) way, real3 normal)
{
    return light_blurs(way, cone_distance(s, towards));
}

/* ---- places ---------------------------------------------------------------------------------- */

FN float cone_size(S(kiln_draw_shape) s)
{
    return SQRT(s.extent.w * s.extent.w + s.extent.y * s.extent.y);
}

REAL_FN truth cone_contains(S(kiln_draw_shape) s, real3 from)
{
    real height = shape_along(s, from);
    real width = cone_slope(s) * (s.extent.y - height);
    return truth_and(height > -s.extent.y, real3_length(shape_across(s, from, height)) < width);
}

/* The farthest place is the tip, or it is on the edge of the base. */
REAL_FN real cone_reach(S(kiln_draw_shape) s, real3 way)
{
    real climb = shape_along(s, way);
    return real_max(s.extent.y * climb, disc_reach(s.extent.w, climb) - s.extent.y * climb);
}

REAL_FN real cone_sky(S(kiln_draw_shape) s, real3 towards, real3 normal)
{
    return sky_beside(towards, normal, cone_distance(s, towards),
                      exact_min(s.extent.y, 0.5f * s.extent.w), cone_reach(s, normal));
}

#endif

/* ---- collision in its frame ------------------------------------------------------------------ */
#if defined(KILN_SHARED_COLLIDE_FRAME_H) && !defined(KILN_CONE_COLLIDES)
#define KILN_CONE_COLLIDES

/* A ball meets the cone with its surface: the side is moved outwards by the ball's radius, and so
 * are the planes of base and tip, so that the cone becomes a frustum. Without a ball, the plane of
 * the tip touches it. */

/* Returns how much the radius shrinks for each metre towards the tip. */
FN float cone_narrows(S(collide_frame) frame)
{
    EXACT float tall = 2.0f * frame.extent.y;
    EXACT float slope = exact_div(frame.radius, tall);
    return slope;
}

/* Returns the length of the side for each metre of the height. slope: cone_narrows. */
FN float cone_length(float slope)
{
    EXACT float square = 1.0f + slope * slope;
    EXACT float length = exact_sqrt(square);
    return length;
}

/* Returns the radius at a height, below 0 beyond the tip. */
FN float cone_width(S(collide_frame) frame, float height)
{
    EXACT float slope = cone_narrows(frame);
    EXACT float below = frame.extent.y - height;
    EXACT float width = slope * below + frame.swell * cone_length(slope);
    return width;
}

/* Returns half of the height with the ball's radius. */
FN float cone_end(S(collide_frame) frame)
{
    EXACT float end = frame.extent.y + frame.swell;
    return end;
}

FN bool cone_holds(S(collide_frame) frame, float3 q)
{
    EXACT float end = cone_end(frame);
    EXACT float width = cone_width(frame, q.y);
    EXACT float3 across = collide_from_axis(q);
    EXACT float excess = collide_round_excess(across, width);
    return excess < 0.0f && q.y < end && -q.y < end;
}

/* The side is tested only on the part of the segment below the plane of the tip, where the radius
 * is not below 0. It changes evenly along the segment, exactly so if the cone does not grow. */
FN S(collide_span) cone_segment(S(collide_frame) start, S(collide_frame) end, float3 a, float3 b)
{
    EXACT S(collide_span) span = collide_span_start();
    EXACT float upper0 = cone_end(start) - a.y;
    EXACT float upper1 = cone_end(end) - b.y;
    EXACT float lower0 = cone_end(start) + a.y;
    EXACT float lower1 = cone_end(end) + b.y;
    bool below0 = upper0 > 0.0f;
    bool below1 = upper1 > 0.0f;
    span.misses = !below0 && !below1;
    if (span.misses) {
        span.outside = true;
        return span;
    }
    EXACT float cut = exact_div(upper0, upper0 - upper1);
    EXACT float first = below0 ? 0.0f : cut;
    EXACT float last = below1 ? 1.0f : cut;
    EXACT float3 way = float3_sub(b, a);
    EXACT float width0 = cone_width(start, a.y);
    EXACT float width1 = cone_width(end, b.y);
    EXACT float wider = width1 - width0;
    EXACT float from_width = below0 ? width0 : width0 + wider * cut;
    EXACT float to_width = below1 ? width1 : width0 + wider * cut;
    from_width = exact_max(from_width, 0.0f);
    to_width = exact_max(to_width, 0.0f);
    EXACT float3 from = below0 ? a : float3_add_scaled(a, way, cut);
    EXACT float3 to = below1 ? b : float3_add_scaled(a, way, cut);
    from = collide_from_axis(from);
    to = collide_from_axis(to);
    span = collide_side(span, from, to, from_width, to_width);
    if (span.misses)
        return span;
    EXACT float part = last - first;
    span.enter = first + span.enter * part;
    if (span.leave <= 1.0f)
        span.leave = first + span.leave * part;
    span = collide_face(span, COLLIDE_LOWER, lower0, lower1);
    span = collide_face(span, COLLIDE_UPPER, upper0, upper1);
    return span;
}

/* Returns the distance of a point inside from the side. */
FN float cone_depth(S(collide_frame) frame, float3 q)
{
    EXACT float3 across = collide_from_axis(q);
    EXACT float aside = float3_length(across);
    EXACT float width = cone_width(frame, q.y);
    EXACT float slope = cone_narrows(frame);
    EXACT float depth = exact_div(width - aside, cone_length(slope));
    return depth;
}

FN uint cone_nearest(S(collide_frame) frame, float3 q)
{
    EXACT float side = cone_depth(frame, q);
    EXACT float end = cone_end(frame);
    return collide_nearest_of(side, end, q);
}

FN float3 cone_normal(S(collide_frame) frame, uint face, float3 q)
{
    EXACT float slope = cone_narrows(frame);
    EXACT float per_length = exact_rcp(cone_length(slope));
    EXACT float3 across = collide_from_axis(q);
    EXACT float3 outwards = collide_side_normal(across);
    outwards.y = slope;
    EXACT float3 normal = float3_scale(outwards, per_length);
    if (face != COLLIDE_SIDE)
        normal = collide_end_normal(face);
    return normal;
}

FN float3 cone_put(S(collide_frame) frame, uint face, float3 q, float gap)
{
    EXACT float3 normal = cone_normal(frame, face, q);
    EXACT float depth = cone_depth(frame, q);
    EXACT float outwards = depth + gap;
    EXACT float3 y = float3_add_scaled(q, normal, outwards);
    EXACT float beyond = frame.swell + gap;
    if (face != COLLIDE_SIDE)
        y = collide_end_put(frame, face, q, beyond);
    return y;
}

/* The side moves by the change of its slope, and with the tip. */
FN float3 cone_grown(S(kiln_collider) c, S(collide_frame) frame, uint face, float3 normal, float3 q)
{
    EXACT float longer = collide_axis_growth(c);
    EXACT float before = exact_div(c.center.w, 2.0f * c.extent.y);
    EXACT float after = exact_div(c.center_end.w, 2.0f * c.extent_end.y);
    EXACT float below = frame.extent.y - q.y;
    EXACT float slope = cone_narrows(frame);
    EXACT float wider = (after - before) * below + slope * longer;
    EXACT float growth = exact_div(wider, cone_length(slope));
    if (face != COLLIDE_SIDE)
        growth = longer;
    EXACT float3 grown = float3_scale(normal, growth);
    return grown;
}

#endif

/* NOLINTEND(misc-unused-parameters) */
