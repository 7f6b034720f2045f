/* Traces spheres and capped cylinders, and finds how much of the sky and of the sun they leave
 * visible from a point. surface.glsl includes it for scenes with such shapes (ROUND).
 * shared/shape_rays.h, sun_cover.h and surface_light.h, where a sphere is called a ball, have the
 * formulas. */

/* Replaces `nearest` by the ray's nearest hit on a sphere if that is nearer. */
void trace_spheres(vec3 origin, vec3 direction, inout hit nearest)
{
    int found = -1;
    for (int i = 0; i < int(shapes.counts.x); i++) {
        ray_interval at = ray_cross_ball(shapes.spheres[i], origin, direction);
        if (ray_meets(at, nearest.t)) {
            nearest.t = at.near;
            found = i;
        }
    }
    if (found >= 0) {
        nearest.normal = normalize(origin + direction * nearest.t - shapes.spheres[found].xyz);
        nearest.albedo = shapes.sphere_color[found].rgb;
        nearest.surface = KILN_SURFACE_SPHERES + found;
    }
}

/* Replaces `nearest` by the ray's nearest hit on a cylinder if that is nearer. */
void trace_cylinders(vec3 origin, vec3 direction, inout hit nearest)
{
    int found = -1;
    bool on_end = false;
    for (int i = 0; i < int(shapes.counts.y); i++) {
        ray_cylinder crossed =
            ray_cross_cylinder(shapes.cylinders[i], shapes.cylinder_axis[i], origin, direction);
        if (ray_meets(crossed.interval, nearest.t)) {
            nearest.t = crossed.interval.near;
            found = i;
            on_end = crossed.on_end;
        }
    }
    if (found >= 0) {
        vec3 axis = shapes.cylinder_axis[found].xyz;
        vec3 from = origin + direction * nearest.t - shapes.cylinders[found].xyz;
        float height = dot(from, axis);
        nearest.normal = on_end ? axis * sign(height) : normalize(from - axis * height);
        nearest.albedo = shapes.cylinder_color[found].rgb;
        int side = 0, upper_end = 1, lower_end = 2; /* parts of a cylinder, with a number each */
        int part = !on_end ? side : height > 0.0 ? upper_end : lower_end;
        nearest.surface = KILN_SURFACE_CYLINDERS + 3 * found + part;
    }
}

/* Returns the part of the sky, 0 to 1, that these shapes leave visible from a surface's point. */
float round_sky_visibility(vec3 point, vec3 normal)
{
    float visible = 1.0;
    for (int i = 0; i < int(shapes.counts.x); i++)
        visible *= sky_beside_ball(shapes.spheres[i].xyz - point, shapes.spheres[i].w, normal);
    for (int i = 0; i < int(shapes.counts.y); i++) {
        vec4 axis = shapes.cylinder_axis[i];
        float radius = shapes.cylinders[i].w;
        vec3 towards = shapes.cylinders[i].xyz - point;
        if (sky_meets_cylinder(towards, radius, axis, normal))
            visible *= sky_beside_cylinder(towards, radius, axis, normal);
    }
    return visible;
}

#ifdef SOFT_SUN

/* Returns the part of the sun, 0 to 1, that these shapes leave visible from a point. */
float round_sun_visibility(vec3 origin)
{
    vec3 sun = backdrop.sun_direction.xyz;
    float spread = shapes.sun_right.w; /* tangent of the sun's radius */
    float visible = 1.0;
    for (int i = 0; i < int(shapes.counts.x); i++)
        visible *= 1.0 - ball_cover(shapes.spheres[i].xyz - origin, shapes.spheres[i].w, sun,
                                    spread, 0.0).cover;
    for (int i = 0; i < int(shapes.counts.y); i++)
        visible *= 1.0 - cylinder_cover(shapes.cylinders[i].xyz - origin, shapes.cylinders[i].w,
                                        shapes.cylinder_axis[i], sun, cover_band_all(shapes.bands[i]),
                                        spread, 0.0).cover;
    return visible;
}

#else

/* Returns 0 if one of these shapes hides the sun, which has no size here, from a point, else 1. */
float round_sun_visibility(vec3 origin)
{
    vec3 sun = backdrop.sun_direction.xyz;
    for (int i = 0; i < int(shapes.counts.x); i++) {
        if (ray_is_blocked(ray_cross_ball(shapes.spheres[i], origin, sun)))
            return 0.0;
    }
    for (int i = 0; i < int(shapes.counts.y); i++) {
        if (ray_is_blocked(ray_cross_cylinder(shapes.cylinders[i], shapes.cylinder_axis[i], origin,
                                              sun).interval))
            return 0.0;
    }
    return 1.0;
}

#endif

/* Returns the part of a lamp that spheres and cylinders leave. casters: starts with their bits,
 * which are taken. */
float round_lamp_visibility(inout uint casters, vec3 origin, lamp_way way)
{
    float visible = 1.0;
    int spheres = casters == 0u ? 0 : int(shapes.counts.x);
    for (int i = 0; i < spheres; i++) {
        vec3 towards = shapes.spheres[i].xyz - origin;
        if (take_caster(casters) && lamp_meets(towards, shapes.spheres[i].w, way))
            visible *= 1.0 - lamp_ball_cover(towards, shapes.spheres[i].w, way);
    }
    int cylinders = casters == 0u ? 0 : int(shapes.counts.y);
    for (int i = 0; i < cylinders; i++) {
        vec3 towards = shapes.cylinders[i].xyz - origin;
        vec4 axis = shapes.cylinder_axis[i];
        float radius = shapes.cylinders[i].w;
        if (take_caster(casters) && lamp_meets(towards, length(vec2(radius, axis.w)), way))
            visible *= 1.0 - lamp_cylinder_cover(towards, radius, axis, way);
    }
    return visible;
}
