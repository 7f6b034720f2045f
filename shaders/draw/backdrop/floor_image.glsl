/* The floor's picture, averaged over what a pixel covers: a parallelogram, along whose longer edge
 * several mipmapped fetches lie, and whose shorter edge chooses their level. */

layout(binding = KILN_UNIT_FLOOR) uniform sampler2D floor_image;

const int FLOOR_TAPS = 8;

/* How far a place on the floor moves with the ray's direction. */
vec2 floor_shift(vec3 direction, vec3 change, float t)
{
    return t * (change.xz - direction.xz * (change.y / direction.y));
}

vec3 floor_picture(vec2 position, vec3 direction, float t)
{
    vec3 right = view_to_world(vec3(2.0 * view.frustum.x / view.frustum.z, 0.0, 0.0));
    vec3 up = view_to_world(vec3(0.0, 2.0 * view.frustum.y / view.frustum.w, 0.0));
    vec2 u = floor_shift(direction, right, t);
    vec2 v = floor_shift(direction, up, t);
    vec2 longer = dot(u, u) > dot(v, v) ? u : v;
    /* The shorter edge by the area: the two need not be square to each other. */
    float width = abs(u.x * v.y - u.y * v.x) / max(length(longer), 1e-9);
    float covered = max(width, length(longer) / float(FLOOR_TAPS));
    float level = log2(max(covered * shapes.floor_map.z, 1e-6));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < FLOOR_TAPS; i++) {
        vec2 at = position + longer * ((float(i) + 0.5) / float(FLOOR_TAPS) - 0.5);
        sum += textureLod(floor_image, at * shapes.floor_map.xy, level).rgb;
    }
    return sum / float(FLOOR_TAPS);
}
