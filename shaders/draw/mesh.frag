/* What a ray hits of a mesh, for backdrop.frag. Both sides of a triangle are seen; the normal is
 * turned to the side that faces the eye. */
#include "draw/mesh_hit.glsl"

uniform int mesh;

layout(location = 0) in vec3 world_normal;
layout(location = 1) in vec3 from_eye;
layout(location = 2) in float depth;

layout(location = 0) out uvec2 out_hit;

void main()
{
    vec3 face = cross(dFdx(from_eye), dFdy(from_eye));
    face = dot(face, from_eye) > 0.0 ? -face : face;
    vec3 normal = dot(world_normal, face) < 0.0 ? -world_normal : world_normal;
    out_hit = pack_mesh_hit(depth, mesh, normal * inversesqrt(max(dot(normal, normal), 1e-12)));
}
