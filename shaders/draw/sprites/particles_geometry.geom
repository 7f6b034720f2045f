/* A point becomes a billboard: four corners around it. */
// variant: SHAPES=0
// variant: SHAPES=1
#include "shared/draw_layout.h"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };

#include "draw/sprites/billboard.glsl"

layout(location = 0) in vec4 center[];
layout(location = 1) in vec4 right[];
layout(location = 2) in vec4 up[];
layout(location = 3) in billboard particle[];

#include "draw/sprites/corner.glsl"

void main()
{
    if (!is_seen(center[0], particle[0]))
        return;
    for (int i = 0; i < 4; i++) {
        put_corner(i, center[0], right[0], up[0], particle[0]);
        EmitVertex();
    }
    EndPrimitive();
}
