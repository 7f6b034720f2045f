/* Projects a mesh as the camera sees it. lib/draw/backdrop/meshes_gl.c draws it once for each ray
 * of a pixel, with a shift that moves the ray to the pixel's centre. With PAINT, the vertices have
 * texture coordinates of the paint. */
// variant:
// variant: PAINT=1
#include "shared/draw_layout.h"
#include "shared/shape_layout.h"

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };
layout(std140, binding = KILN_BIND_SHAPES) uniform shape_block { kiln_draw_shapes shapes; };

uniform int mesh;
uniform vec2 shift; /* px */

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
#ifdef PAINT
layout(location = 2) in vec2 place_in_paint;
#endif

layout(location = 0) out vec3 world_normal;
layout(location = 1) out vec3 from_eye;
layout(location = 2) out float depth;
#ifdef PAINT
layout(location = 3) out vec2 uv;
#endif

const float NEAREST = 0.01; /* near plane, m; a camera may have a nearer one */

void main()
{
    vec4 rows[3] = shapes.meshes[mesh].to_world;
    vec4 local = vec4(position, 1.0);
    vec4 world = vec4(dot(rows[0], local), dot(rows[1], local), dot(rows[2], local), 1.0);
    world_normal = vec3(dot(rows[0].xyz, normal), dot(rows[1].xyz, normal), dot(rows[2].xyz, normal));
    from_eye = world.xyz - view.eye.xyz;
    vec3 seen = vec3(dot(view.world_to_view[0], world), dot(view.world_to_view[1], world),
                     dot(view.world_to_view[2], world));
    depth = -seen.z;
    seen.xy += view.principal.zw * depth;
    vec2 place = vec2(seen.x, -seen.y) / view.frustum.xy + shift * 2.0 / view.frustum.zw * depth;
#ifdef PAINT
    uv = place_in_paint;
#endif
    gl_Position = vec4(place, depth - 2.0 * min(NEAREST, view.eye.w), depth); /* the far plane is at infinity */
}
