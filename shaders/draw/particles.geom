/* A point becomes a billboard: four corners around the view-space position, in the plane that the
 * vertex shader chose, then projected (Heinz 2019, 3.2.3, equation 3.1). Points and lines are quads
 * of the picture, measured in pixels.
 */
// variant: SHAPES=0
// variant: SHAPES=1
#include "shared/draw_layout.h"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };

#include "draw/billboard.glsl"

layout(location = 0) in vec4 center[];
layout(location = 1) in vec4 right[];
layout(location = 2) in vec4 up[];
layout(location = 3) in billboard particle[];

layout(location = 0) out vec2 uv;
layout(location = 1) flat out billboard quad;
#if SHAPES
layout(location = 11) out float view_depth;
#endif

void emit_corner(vec2 corner)
{
    vec3 v = center[0].xyz + (right[0].xyz * corner.x + up[0].xyz * corner.y);
    /* Only x, y and w matter: depth is compared in the fragment shader, as for soft particles. */
    gl_Position = vec4(v.x / view.frustum.x, -v.y / view.frustum.y, 0.0, -v.z);
    uv = vec2(0.5 + 0.5 * corner.x, 0.5 - 0.5 * corner.y);
    quad = particle[0];
#if SHAPES
    view_depth = -v.z;
#endif
    EmitVertex();
}

#if SHAPES

/* Pixels right and down from the middle of the picture. */
vec2 to_pixels(vec3 v)
{
    return vec2(v.x / view.frustum.x, v.y / -view.frustum.y) * (0.5 * view.frustum.zw / -v.z);
}

/* A line, or a point as a line of no length: its ends reach out by half of its width. It leaves
 * half a pixel around it for soft edges. uv: pixels from its middle, along and across. */
void emit_plain()
{
    vec3 head = center[0].xyz, tail = head + up[0].xyz;
    float near = max(view.eye.w, 1e-3);
    if (-tail.z < near)
        tail = mix(head, tail, (-head.z - near) / (tail.z - head.z));
    vec2 from = to_pixels(tail), to = to_pixels(head), way = to - from;
    float way_px = length(way);
    vec2 along = way_px > 1e-3 ? way / way_px : vec2(1.0, 0.0);
    vec2 extent = vec2(0.5 * way_px, 0.0) + right[0].w;
    for (int i = 0; i < 4; i++) {
        uv = (extent + 0.5) * vec2(i < 2 ? -1.0 : 1.0, (i & 1) == 0 ? 1.0 : -1.0);
        vec2 pixel = 0.5 * (from + to) + along * uv.x + vec2(-along.y, along.x) * uv.y;
        gl_Position = vec4(pixel / (0.5 * view.frustum.zw), 0.0, 1.0);
        view_depth = 1.0 / -(i < 2 ? tail.z : head.z); /* what changes evenly in the picture */
        quad = particle[0];
        quad.cells.xy = extent;
        EmitVertex();
    }
    EndPrimitive();
}

#endif

void main()
{
    if (-center[0].z <= view.eye.w || particle[0].color.a <= 0.0)
        return;
#if SHAPES
    if (center[0].w > 0.0) {
        emit_plain();
        return;
    }
#endif
    emit_corner(vec2(-1.0, 1.0));
    emit_corner(vec2(-1.0, -1.0));
    emit_corner(vec2(1.0, 1.0));
    emit_corner(vec2(1.0, -1.0));
    EndPrimitive();
}
