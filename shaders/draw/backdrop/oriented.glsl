/* Traces capsules, boxes of any direction and planes, and finds how much of the sky and of the sun
 * they leave visible from a point. A plane hides the same part of the sun from all points above it,
 * so the host dims the sun's colour by planes. */

/* ---- capsules ---- */

void trace_capsules(vec3 origin, vec3 direction, inout hit nearest)
{
    int found = -1;
    for (int i = 0; i < int(shapes.oriented_counts.x); i++) {
        ray_interval at =
            ray_cross_capsule(shapes.capsules[i], shapes.capsule_axis[i], origin, direction);
        if (ray_meets(at, nearest.t)) {
            nearest.t = at.near;
            found = i;
        }
    }
    if (found >= 0) {
        vec3 axis = shapes.capsule_axis[found].xyz;
        float halves = shapes.capsule_axis[found].w;
        vec3 from = origin + direction * nearest.t - shapes.capsules[found].xyz;
        nearest.normal = normalize(from - axis * clamp(dot(from, axis), -halves, halves));
        nearest.albedo = shapes.capsule_color[found].rgb;
        nearest.surface = KILN_SURFACE_CAPSULES + found;
    }
}

/* ---- boxes ---- */

/* Returns a world-space vector in the frame of box i; out_of_box does the inverse. */
vec3 into_box(int i, vec3 v)
{
    return vec3(dot(v, shapes.oriented_boxes[i].rows[0].xyz),
                dot(v, shapes.oriented_boxes[i].rows[1].xyz),
                dot(v, shapes.oriented_boxes[i].rows[2].xyz));
}

vec3 out_of_box(int i, vec3 v)
{
    return v.x * shapes.oriented_boxes[i].rows[0].xyz + v.y * shapes.oriented_boxes[i].rows[1].xyz +
           v.z * shapes.oriented_boxes[i].rows[2].xyz;
}

/* Intersects a ray with the slabs of box i. inverse: ray_inverse3 of the ray's direction in the
 * box's frame. */
ray_slabs cross_oriented_box(int i, vec3 origin, vec3 inverse)
{
    return ray_cross_slabs(into_box(i, shapes.oriented_boxes[i].center.xyz - origin),
                           shapes.oriented_boxes[i].half_size, inverse);
}

void trace_oriented_boxes(vec3 origin, vec3 direction, inout hit nearest)
{
    int found = -1;
    for (int i = 0; i < int(shapes.oriented_counts.y); i++) {
        vec3 inverse = ray_inverse3(into_box(i, direction));
        ray_interval at = ray_slabs_interval(cross_oriented_box(i, origin, inverse));
        if (ray_meets(at, nearest.t)) {
            nearest.t = at.near;
            found = i;
        }
    }
    if (found >= 0) {
        vec3 inverse = ray_inverse3(into_box(found, direction));
        vec3 normal = ray_slabs_normal(cross_oriented_box(found, origin, inverse), inverse);
        nearest.normal = out_of_box(found, normal);
        nearest.albedo = shapes.oriented_boxes[found].color.rgb;
        nearest.surface =
            KILN_SURFACE_BOX(KILN_SURFACE_ORIENTED, found) + int(ray_face_number(normal));
    }
}

/* ---- planes ---- */

void trace_planes(vec3 origin, vec3 direction, inout hit nearest)
{
    for (int i = 0; i < int(shapes.oriented_counts.z); i++) {
        vec4 plane = shapes.planes[i];
        float height = dot(origin, plane.xyz) - plane.w;
        float t = ray_cross_plane(height, dot(direction, plane.xyz));
        if (t < nearest.t)
            nearest = hit(t, KILN_SURFACE_PLANES + i, plane.xyz, shapes.plane_color[i].rgb);
    }
}

/* ---- sky and sun ---- */

float oriented_sky_visibility(vec3 point, vec3 normal)
{
    float visible = 1.0;
    for (int i = 0; i < int(shapes.oriented_counts.x); i++)
        visible *= sky_beside_capsule(shapes.capsules[i].xyz - point, shapes.capsules[i].w,
                                      shapes.capsule_axis[i], normal);
    for (int i = 0; i < int(shapes.oriented_counts.y); i++) {
        vec3 towards = into_box(i, shapes.oriented_boxes[i].center.xyz - point);
        vec3 facing = into_box(i, normal);
        if (sky_meets_box(shapes.oriented_boxes[i].half_size, towards, facing))
            visible *= sky_beside_box(shapes.oriented_boxes[i].half_size, towards, facing);
    }
    return visible;
}

float oriented_sun_visibility(vec3 origin)
{
    vec3 sun = backdrop.sun_direction.xyz;
    float visible = 1.0;
    for (int i = 0; i < int(shapes.oriented_counts.x); i++) {
#ifdef SOFT_SUN
        vec3 towards =
            capsule_nearest(shapes.capsules[i].xyz - origin, shapes.capsule_axis[i], sun);
        visible *= 1.0 - ball_cover(towards, shapes.capsules[i].w, sun, shapes.sun_right.w, 0.0).cover;
#else
        if (ray_is_blocked(ray_cross_capsule(shapes.capsules[i], shapes.capsule_axis[i], origin,
                                             sun)))
            return 0.0;
#endif
    }
    for (int i = 0; i < int(shapes.oriented_counts.y); i++)
        visible *= box_sun_visibility(
            cross_oriented_box(i, origin, shapes.oriented_edges[i].inverse.xyz),
            shapes.oriented_edges[i]);
    return visible;
}

/* ---- lamps ---- */

/* Returns the part of a lamp that capsules and boxes leave. casters: starts with their bits, which
 * are taken. */
float oriented_lamp_visibility(inout uint casters, vec3 origin, lamp_way way)
{
    float visible = 1.0;
    int capsules = casters == 0u ? 0 : int(shapes.oriented_counts.x);
    for (int i = 0; i < capsules; i++) {
        vec3 towards = shapes.capsules[i].xyz - origin;
        vec4 axis = shapes.capsule_axis[i];
        float radius = shapes.capsules[i].w;
        if (take_caster(casters) && lamp_meets(towards, radius + axis.w, way))
            visible *= 1.0 - lamp_capsule_cover(towards, radius, axis, way);
    }
    int boxes = casters == 0u ? 0 : int(shapes.oriented_counts.y);
    for (int i = 0; i < boxes; i++) {
        vec3 towards = shapes.oriented_boxes[i].center.xyz - origin;
        vec4 halves = shapes.oriented_boxes[i].half_size;
        if (take_caster(casters) && lamp_meets(towards, halves.w, way))
            visible *= 1.0 - lamp_box_cover(into_box(i, towards), halves,
                                            into_box(i, way.direction), way);
    }
    return visible;
}
