/* Writes a texel of a mesh's shadow map for each pixel that the mesh covers as the sun sees it: 1
 * for the coverage, and the depth, 0 nearest to the sun and 1 farthest.
 * lib/draw/backdrop/meshes_gl.c draws with it when the sun or a mesh has changed. Texels that no
 * mesh covers stay 0, 0. Coarser levels are averages, and mesh_sun_cover of mesh_trace.glsl divides
 * the depth by the coverage, so the second number must be the depth times the coverage.
 * lib/draw/light/mesh_shadow.c makes the same map on the host. */
layout(location = 0) in float depth;

layout(location = 0) out vec2 out_seen;

void main()
{
    out_seen = vec2(1.0, depth);
}
