/* Where a ray enters and leaves balls and capped cylinders. */

/* The discriminant from the vector across the ray, which keeps its digits far away. */
vec2 ball_interval(vec3 center, float radius, vec3 origin, vec3 direction)
{
    vec3 from = origin - center;
    float a = dot(direction, direction);
    float middle = -dot(from, direction) / a;
    vec3 across = from + direction * middle;
    float inside = (radius * radius - dot(across, across)) / a;
    float extent = sqrt(max(inside, 0.0));
    return inside > 0.0 ? vec2(middle - extent, middle + extent) : vec2(1.0, -1.0);
}

struct cylinder_hit {
    vec2 interval;
    bool on_end; /* enters through a flat end */
};

/* center: w: radius; axis: unit; w: half of the height. */
cylinder_hit cross_cylinder(vec4 center, vec4 axis, vec3 origin, vec3 direction)
{
    float radius = center.w;
    vec3 from = origin - center.xyz;
    float height = dot(from, axis.xyz);
    float climb = dot(direction, axis.xyz);
    vec3 flat_from = from - axis.xyz * height;
    vec3 flat_direction = direction - axis.xyz * climb;

    float a = max(dot(flat_direction, flat_direction), 1e-12);
    float middle = -dot(flat_from, flat_direction) / a;
    vec3 across = flat_from + flat_direction * middle;
    float inside = (radius * radius - dot(across, across)) / a;
    float extent = sqrt(max(inside, 0.0));

    float inverse = (climb < 0.0 ? -1.0 : 1.0) / max(abs(climb), 1e-8);
    float slab_middle = -height * inverse;
    float slab_extent = axis.w * abs(inverse);

    vec2 side = inside > 0.0 ? vec2(middle - extent, middle + extent) : vec2(1.0, -1.0);
    vec2 slab = vec2(slab_middle - slab_extent, slab_middle + slab_extent);
    return cylinder_hit(vec2(max(side.x, slab.x), inside > 0.0 ? min(side.y, slab.y) : -1e9),
                        slab.x > side.x);
}

/* What a ball hides of the sky from a point, by the way to its centre. */
float ball_sky_visibility(vec3 towards, float radius, vec3 normal)
{
    float d2 = max(dot(towards, towards), 1e-9);
    float facing = clamp(dot(towards, normal) * inversesqrt(d2) + 0.4, 0.0, 1.0);
    return 1.0 - 0.7 * facing * min(radius * radius / d2, 1.0);
}
