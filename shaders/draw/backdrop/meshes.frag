/* Writes where the ray through a pixel hits a mesh, for backdrop.frag. Both sides of a triangle are
 * visible; the normal is turned to the side that faces the eye. With PAINT, it also writes the
 * texture coordinates of the paint and the logarithm of the texture's extent that a pixel covers: a
 * square of the area that the slopes of the coordinates span, or with half of the longer slope as
 * its edge. */
// variant:
// variant: PAINT=1
// variant: MANY_MESHES=1
#include "draw/backdrop/mesh_hit.glsl"

uniform int mesh;

layout(location = 0) in vec3 world_normal;
layout(location = 1) in vec3 from_eye;
layout(location = 2) in float depth;
#ifdef PAINT
layout(location = 3) in vec2 uv;
#endif

#ifdef PAINT
layout(location = 0) out uvec4 out_hit;
#else
layout(location = 0) out uvec2 out_hit;
#endif

void main()
{
    gl_FragDepth = 1.0 / (1.0 + depth); /* near is 1, far is 0, as in solids_spheres.frag */
    vec3 face = cross(dFdx(from_eye), dFdy(from_eye));
    face = dot(face, from_eye) > 0.0 ? -face : face;
    vec3 normal = dot(world_normal, face) < 0.0 ? -world_normal : world_normal;
    uvec2 found = pack_mesh_hit(depth, mesh, normal * inversesqrt(max(dot(normal, normal), 1e-12)));
#ifdef PAINT
    vec2 right = dFdx(uv), down = dFdy(uv);
    float area = abs(right.x * down.y - right.y * down.x);
    float square = max(area, 0.25 * max(dot(right, right), dot(down, down)));
    float level = 0.5 * log2(clamp(square, 1e-12, 1e12));
    out_hit = uvec4(found, packUnorm2x16(uv), floatBitsToUint(level));
#else
    out_hit = found;
#endif
}
