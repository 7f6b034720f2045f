/* A point becomes a screen-aligned billboard: four corners around the view-space position, rotated
 * about the view axis, then projected (Heinz 2019, 3.2.3, equation 3.1). */
#include "shared/draw_layout.h"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };

#include "draw/billboard.glsl"

layout(location = 0) in vec4 center[];
layout(location = 1) in vec4 axes[];
layout(location = 2) in billboard particle[];

layout(location = 0) out vec2 uv;
layout(location = 1) flat out billboard quad;

void emit_corner(vec2 corner)
{
    vec2 offset = axes[0].xy * corner.x + axes[0].zw * corner.y;
    vec3 v = vec3(center[0].xy + offset, center[0].z);
    /* Only x, y and w matter: depth is compared in the fragment shader, as for soft particles. */
    gl_Position = vec4(v.x / view.frustum.x, -v.y / view.frustum.y, 0.0, -v.z);
    uv = vec2(0.5 + 0.5 * corner.x, 0.5 - 0.5 * corner.y);
    quad = particle[0];
    EmitVertex();
}

void main()
{
    if (-center[0].z <= view.eye.w || particle[0].color.a <= 0.0)
        return;
    emit_corner(vec2(-1.0, 1.0));
    emit_corner(vec2(-1.0, -1.0));
    emit_corner(vec2(1.0, 1.0));
    emit_corner(vec2(1.0, -1.0));
    EndPrimitive();
}
