/* Projects a mesh, seen from the sun, into its own shadow map (meshes_shadow.frag). The sphere
 * around the mesh fills the map except for a border. */
#include "shared/draw_layout.h"
#include "shared/shape_layout.h"

layout(std140, binding = KILN_BIND_BACKDROP) uniform backdrop_block { kiln_draw_backdrop backdrop; };
layout(std140, binding = KILN_BIND_SHAPES) uniform shape_block { kiln_draw_shapes shapes; };

uniform int mesh;

layout(location = 0) in vec3 position;

layout(location = 0) out float depth;

void main()
{
    vec4 rows[3] = shapes.meshes[mesh].to_world;
    vec4 local = vec4(position, 1.0);
    vec3 world = vec3(dot(rows[0], local), dot(rows[1], local), dot(rows[2], local));
    vec3 from = world - shapes.meshes[mesh].center.xyz;
    float radius = shapes.meshes[mesh].center.w * (1.0 + KILN_SHADOW_MARGIN);
    float towards = dot(from, backdrop.sun_direction.xyz) / radius;
    depth = 0.5 - 0.5 * towards;
    gl_Position = vec4(dot(from, shapes.sun_right.xyz) / radius, dot(from, shapes.sun_up.xyz) / radius,
                       -towards, 1.0);
}
