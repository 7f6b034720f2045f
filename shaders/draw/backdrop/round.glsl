/* Spheres and capped cylinders, cast like the boxes of backdrop.frag. */

vec2 sphere_interval(int i, vec3 origin, vec3 direction)
{
    return ball_interval(shapes.spheres[i].xyz, shapes.spheres[i].w, origin, direction);
}

/* Replaces `nearest` by what the ray hits before it. */
void trace_spheres(vec3 origin, vec3 direction, inout hit nearest)
{
    int found = -1;
    for (int i = 0; i < int(shapes.counts.x); i++) {
        vec2 interval = sphere_interval(i, origin, direction);
        if (interval.x <= interval.y && interval.x > 0.0 && interval.x < nearest.t) {
            nearest.t = interval.x;
            found = i;
        }
    }
    if (found >= 0) {
        nearest.normal = normalize(origin + direction * nearest.t - shapes.spheres[found].xyz);
        nearest.albedo = shapes.sphere_color[found].rgb;
        nearest.surface = SURFACE_SPHERES + found;
    }
}

void trace_cylinders(vec3 origin, vec3 direction, inout hit nearest)
{
    int found = -1;
    bool on_end = false;
    for (int i = 0; i < int(shapes.counts.y); i++) {
        cylinder_hit crossing =
            cross_cylinder(shapes.cylinders[i], shapes.cylinder_axis[i], origin, direction);
        vec2 interval = crossing.interval;
        if (interval.x <= interval.y && interval.x > 0.0 && interval.x < nearest.t) {
            nearest.t = interval.x;
            found = i;
            on_end = crossing.on_end;
        }
    }
    if (found >= 0) {
        vec3 axis = shapes.cylinder_axis[found].xyz;
        vec3 from = origin + direction * nearest.t - shapes.cylinders[found].xyz;
        float height = dot(from, axis);
        nearest.normal = on_end ? axis * sign(height) : normalize(from - axis * height);
        nearest.albedo = shapes.cylinder_color[found].rgb;
        int part = on_end ? height > 0.0 ? 1 : 2 : 0;
        nearest.surface = SURFACE_CYLINDERS + 3 * found + part;
    }
}

/* Where a shape is wholly on the other side of its own surface point, it hides no sky from it. */
float round_sky_visibility(vec3 point, vec3 normal)
{
    float visible = 1.0;
    for (int i = 0; i < int(shapes.counts.x); i++) {
        vec3 towards = shapes.spheres[i].xyz - point;
        visible *= ball_sky_visibility(towards, shapes.spheres[i].w, normal);
    }
    for (int i = 0; i < int(shapes.counts.y); i++) {
        vec3 axis = shapes.cylinder_axis[i].xyz;
        float halves = shapes.cylinder_axis[i].w, radius = shapes.cylinders[i].w;
        vec3 towards = shapes.cylinders[i].xyz - point;
        float height = dot(towards, axis);
        vec3 aside = towards - axis * height;
        float above = max(abs(height) - halves, 0.0);
        float beside = max(length(aside) - radius, 0.0);
        float facing = clamp(dot(towards, normal) * inversesqrt(dot(towards, towards)) + 0.4, 0.0, 1.0);
        /* How far the shape reaches towards the normal: on its own surface, not at all. */
        float climb = dot(axis, normal);
        float reach = halves * abs(climb) + radius * sqrt(max(1.0 - climb * climb, 0.0));
        float fall = 1.0 / (1.0 + 2.0 * length(vec2(above, beside)) / min(halves, radius));
        if (dot(towards, normal) > -reach + 1e-3)
            visible *= 1.0 - 0.7 * facing * fall * fall;
    }
    return visible;
}

#ifdef SOFT_SUN

float round_sun_visibility(vec3 origin)
{
    vec3 sun = backdrop.sun_direction.xyz;
    float spread = shapes.sun_right.w;
    float visible = 1.0;
    for (int i = 0; i < int(shapes.counts.x); i++) {
        vec3 towards = shapes.spheres[i].xyz - origin;
        float radius = shapes.spheres[i].w;
        float t = dot(towards, sun);
        float across = length(towards - sun * t);
        visible *= 1.0 - strip_cover(radius - across, radius + across, t * spread) * step(0.0, t);
    }
    for (int i = 0; i < int(shapes.counts.y); i++) {
        vec3 axis = shapes.cylinder_axis[i].xyz;
        float halves = shapes.cylinder_axis[i].w, radius = shapes.cylinders[i].w;
        vec3 towards = shapes.cylinders[i].xyz - origin;
        float climb = dot(axis, sun);
        float slant = sqrt(max(1.0 - climb * climb, 1e-6));
        /* Its silhouette is a band along `up`, with round ends; seen along its axis, it is round. */
        vec3 right = slant > 1e-3 ? cross(axis, sun) / slant : shapes.sun_right.xyz;
        vec3 up = cross(sun, right);
        float x = dot(towards, right), y = dot(towards, up);
        float along = clamp(-y / (slant * (dot(axis, up) < 0.0 ? -1.0 : 1.0)), -halves, halves);
        float t = max(dot(towards, sun) + along * climb, 0.0);
        float end = halves * slant + abs(climb) * sqrt(max(radius * radius - x * x, 0.0));
        float sides = strip_cover(radius - abs(x), radius + abs(x), t * spread);
        float ends = strip_cover(end - abs(y), end + abs(y), t * spread);
        /* On its way to the sun, light that starts beside it or beyond an end may lead only away. */
        float height = -dot(towards, axis);
        vec3 aside = -towards - axis * height;
        bool leads_away = abs(height) >= halves && height * climb > 0.0 ||
                          dot(aside, aside) >= radius * radius && dot(aside, sun) > 0.0;
        visible *= leads_away ? 1.0 : 1.0 - sides * ends;
    }
    return visible;
}

#else

float round_sun_visibility(vec3 origin)
{
    vec3 sun = backdrop.sun_direction.xyz;
    for (int i = 0; i < int(shapes.counts.x); i++) {
        vec2 interval = sphere_interval(i, origin, sun);
        if (max(interval.x, 0.0) < interval.y)
            return 0.0;
    }
    for (int i = 0; i < int(shapes.counts.y); i++) {
        vec2 interval =
            cross_cylinder(shapes.cylinders[i], shapes.cylinder_axis[i], origin, sun).interval;
        if (max(interval.x, 0.0) < interval.y)
            return 0.0;
    }
    return 1.0;
}

#endif
