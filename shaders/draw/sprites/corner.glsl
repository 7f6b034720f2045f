/* Corners of a quad in the plane that draw/sprites/particle.glsl chose, around the view-space position, then
 * projected (Heinz 2019, 3.2.3, equation 3.1). Points and lines are quads of the picture, measured in
 * pixels. The view block must be declared.
 */
#include "draw/sprites/occlusion.glsl"

layout(location = 0) out vec2 uv;
layout(location = 1) flat out billboard quad;
#if SHAPES
layout(location = 11) out float view_depth;
#endif

bool is_seen(vec4 center, billboard particle)
{
    return -center.z > view.eye.w && particle.color.a > 0.0;
}

#if SHAPES

/* Pixels right and down from the middle of the picture. */
vec2 to_pixels(vec3 v)
{
    return vec2(v.x / view.frustum.x, v.y / -view.frustum.y) * (0.5 * view.frustum.zw / -v.z);
}

/* A line, or a point as a line of no length: its ends reach out by half of its width. It leaves
 * half a pixel around it for soft edges. uv: pixels from its middle, along and across. */
void put_plain_corner(vec2 corner, vec3 head, vec3 way_m, float half_width_px)
{
    vec3 tail = head + way_m;
    float near = max(view.eye.w, 1e-3);
    if (-tail.z < near)
        tail = mix(head, tail, (-head.z - near) / (tail.z - head.z));
    vec2 from = to_pixels(tail), to = to_pixels(head), way = to - from;
    float way_px = length(way);
    vec2 along = way_px > 1e-3 ? way / way_px : vec2(1.0, 0.0);
    vec2 extent = vec2(0.5 * way_px, 0.0) + half_width_px;
    uv = (extent + 0.5) * corner;
    vec2 pixel = 0.5 * (from + to) + along * uv.x + vec2(-along.y, along.x) * uv.y;
    gl_Position = vec4(pixel / (0.5 * view.frustum.zw), occlusion_place(-max(tail.z, head.z)), 1.0);
    view_depth = 1.0 / -(corner.x < 0.0 ? tail.z : head.z); /* what changes evenly in the picture */
    quad.cells.xy = extent;
}

#endif

/* Corner i of a strip of two triangles. */
void put_corner(int i, vec4 center, vec4 right, vec4 up, billboard particle)
{
    vec2 corner = vec2(i < 2 ? -1.0 : 1.0, (i & 1) == 0 ? 1.0 : -1.0);
    quad = particle;
#if SHAPES
    if (center.w > 0.0) {
        put_plain_corner(corner, center.xyz, up.xyz, right.w);
        return;
    }
#endif
    vec3 v = center.xyz + (right.xyz * corner.x + up.xyz * corner.y);
    /* Of all of it that of the nearest corner: the fragment shader compares exact depths. */
    float nearest = -(center.z + abs(right.z) + abs(up.z));
    gl_Position = vec4(v.x / view.frustum.x, -v.y / view.frustum.y,
                       occlusion_place(nearest) * -v.z, -v.z);
    uv = vec2(0.5 + 0.5 * corner.x, 0.5 - 0.5 * corner.y);
#if SHAPES
    view_depth = -v.z;
#endif
}
