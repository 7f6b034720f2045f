/* Draws a mesh, seen from the sun, into the mesh's own shadow map. Red is the coverage, 1 where the
 * mesh is. Green is the depth times the coverage; the depth goes from 0, nearest to the sun, to 1
 * over the sphere around the mesh. Texels that the mesh does not cover stay (0, 0).
 *
 * lib/draw/backdrop/meshes_gl.c draws all maps with this shader when the sun or a mesh has changed.
 * The coarser mip levels are averages, so mesh_sun_cover of mesh_trace.glsl divides green by red to
 * get the mean depth. lib/draw/light/mesh_shadow.c draws the same map on the host, in 16 bits a
 * number. */
layout(location = 0) in float depth;

layout(location = 0) out vec2 out_shadow;

void main()
{
    out_shadow = vec2(1.0, depth); /* depth times a coverage of 1 */
}
