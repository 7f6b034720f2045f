/* Capsules, boxes of any direction and planes, cast like the boxes of backdrop.frag. A plane's shadow
 * is all or nothing: it is in the sun's colour. */

/* ---- capsules: two balls and a barrel between them ---- */

vec2 either_interval(vec2 a, vec2 b)
{
    if (a.x > a.y)
        return b;
    return b.x > b.y ? a : vec2(min(a.x, b.x), max(a.y, b.y));
}

vec2 capsule_interval(int i, vec3 origin, vec3 direction)
{
    vec3 center = shapes.capsules[i].xyz;
    vec3 end = shapes.capsule_axis[i].xyz * shapes.capsule_axis[i].w;
    float radius = shapes.capsules[i].w;
    vec2 balls = either_interval(ball_interval(center - end, radius, origin, direction),
                                 ball_interval(center + end, radius, origin, direction));
    cylinder_hit barrel =
        cross_cylinder(shapes.capsules[i], shapes.capsule_axis[i], origin, direction);
    return either_interval(barrel.interval, balls);
}

void trace_capsules(vec3 origin, vec3 direction, inout hit nearest)
{
    int found = -1;
    for (int i = 0; i < int(shapes.more.x); i++) {
        vec2 interval = capsule_interval(i, origin, direction);
        if (interval.x <= interval.y && interval.x > 0.0 && interval.x < nearest.t) {
            nearest.t = interval.x;
            found = i;
        }
    }
    if (found >= 0) {
        vec3 axis = shapes.capsule_axis[found].xyz;
        float halves = shapes.capsule_axis[found].w;
        vec3 from = origin + direction * nearest.t - shapes.capsules[found].xyz;
        nearest.normal = normalize(from - axis * clamp(dot(from, axis), -halves, halves));
        nearest.albedo = shapes.capsule_color[found].rgb;
        nearest.surface = SURFACE_CAPSULES + found;
    }
}

/* ---- boxes ---- */

/* A direction of the world in the frame of box i, and back. */
vec3 into_box(int i, vec3 v)
{
    return vec3(dot(v, shapes.turned[i].rows[0].xyz), dot(v, shapes.turned[i].rows[1].xyz),
                dot(v, shapes.turned[i].rows[2].xyz));
}

vec3 out_of_box(int i, vec3 v)
{
    return v.x * shapes.turned[i].rows[0].xyz + v.y * shapes.turned[i].rows[1].xyz +
           v.z * shapes.turned[i].rows[2].xyz;
}

/* Where a ray enters and leaves its slabs; inverse: of the ray's direction there. */
void turned_slabs(int i, vec3 origin, vec3 inverse, out vec3 near, out vec3 far)
{
    vec3 center = into_box(i, shapes.turned[i].center.xyz - origin) * inverse;
    vec3 extent = shapes.turned[i].half_size.xyz * abs(inverse);
    near = center - extent;
    far = center + extent;
}

void trace_turned(vec3 origin, vec3 direction, inout hit nearest)
{
    int found = -1;
    vec3 normal = vec3(0.0);
    for (int i = 0; i < int(shapes.more.y); i++) {
        vec3 inverse = safe_inverse(into_box(i, direction)), near, far;
        turned_slabs(i, origin, inverse, near, far);
        float t = max(max(near.x, near.y), near.z);
        if (t <= min(min(far.x, far.y), far.z) && t > 0.0 && t < nearest.t) {
            nearest.t = t;
            found = i;
            vec3 last = vec3(near.x >= near.y && near.x >= near.z, near.y > near.x && near.y >= near.z,
                             near.z > near.x && near.z > near.y);
            normal = -last * sign(inverse);
        }
    }
    if (found >= 0) {
        nearest.normal = out_of_box(found, normal);
        nearest.albedo = shapes.turned[found].color.rgb;
        nearest.surface = SURFACE_TURNED + 14 + 27 * found + int(dot(normal, vec3(1.0, 3.0, 9.0)));
    }
}

/* ---- planes ---- */

void trace_planes(vec3 origin, vec3 direction, inout hit nearest)
{
    for (int i = 0; i < int(shapes.more.z); i++) {
        vec4 plane = shapes.planes[i];
        float height = dot(origin, plane.xyz) - plane.w;
        float climb = dot(direction, plane.xyz);
        float t = climb < -1e-6 && height > 0.0 ? height / -climb : 2.0 * FAR;
        if (t < nearest.t)
            nearest = hit(t, SURFACE_PLANES + i, plane.xyz, shapes.plane_color[i].rgb);
    }
}

/* ---- sky and sun ---- */

/* As for boxes along the axes, and for spheres: of a capsule, the nearest one. */
float turned_sky_visibility(vec3 point, vec3 normal)
{
    float visible = 1.0;
    for (int i = 0; i < int(shapes.more.x); i++) {
        vec3 axis = shapes.capsule_axis[i].xyz;
        float halves = shapes.capsule_axis[i].w;
        vec3 towards = shapes.capsules[i].xyz - point;
        towards += axis * clamp(-dot(towards, axis), -halves, halves);
        visible *= ball_sky_visibility(towards, shapes.capsules[i].w, normal);
    }
    for (int i = 0; i < int(shapes.more.y); i++) {
        vec3 towards = into_box(i, shapes.turned[i].center.xyz - point);
        visible *=
            box_sky_visibility(towards, shapes.turned[i].half_size.xyz, into_box(i, normal));
    }
    return visible;
}

#ifdef SOFT_SUN

float turned_sun_visibility(vec3 origin)
{
    vec3 sun = backdrop.sun_direction.xyz;
    float spread = shapes.sun_right.w;
    float visible = 1.0;
    for (int i = 0; i < int(shapes.more.x); i++) {
        /* Of the balls that a capsule is made of, the one that the ray passes most closely. */
        vec3 axis = shapes.capsule_axis[i].xyz;
        float halves = shapes.capsule_axis[i].w, radius = shapes.capsules[i].w;
        vec3 towards = shapes.capsules[i].xyz - origin;
        float climb = dot(axis, sun);
        vec3 flat_axis = axis - sun * climb;
        float along = -dot(towards, flat_axis) / max(dot(flat_axis, flat_axis), 1e-6);
        towards += axis * clamp(along, -halves, halves);
        float t = dot(towards, sun);
        float across = length(towards - sun * t);
        visible *= 1.0 - strip_cover(radius - across, radius + across, t * spread) * step(0.0, t);
    }
    for (int i = 0; i < int(shapes.more.y); i++) {
        vec3 there = into_box(i, sun), inverse = safe_inverse(there), near, far;
        turned_slabs(i, origin, inverse, near, far);
        visible *= 1.0 - box_cover(near, far, inverse, edges_alike(there), spread);
    }
    return visible;
}

#else

float turned_sun_visibility(vec3 origin)
{
    vec3 sun = backdrop.sun_direction.xyz;
    for (int i = 0; i < int(shapes.more.x); i++) {
        vec2 interval = capsule_interval(i, origin, sun);
        if (max(interval.x, 0.0) < interval.y)
            return 0.0;
    }
    for (int i = 0; i < int(shapes.more.y); i++) {
        vec3 near, far;
        turned_slabs(i, origin, safe_inverse(into_box(i, sun)), near, far);
        if (max(max(max(near.x, near.y), near.z), 0.0) < min(min(far.x, far.y), far.z))
            return 0.0;
    }
    return 1.0;
}

#endif
