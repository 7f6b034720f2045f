/* Makes the primitives of the two passes of backdrop.frag. The first pass has one triangle that
 * covers the picture. The second, with at_edges, has a point for each tile of the picture, which
 * covers the tile if it may have pixels at edges; otherwise it lies outside of the picture. */
#include "shared/draw_layout.h"

layout(location = BACKDROP_AT_EDGES) uniform bool at_edges;

#include "draw/backdrop/backdrop_edges.glsl"

void main()
{
    ivec2 size = textureSize(surfaces, 0);
    int columns = (size.x + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    ivec2 first = ivec2(gl_VertexID % columns, gl_VertexID / columns) * KILN_EDGE_TILE;
    /* GL draws a point only if its centre is in the picture, so tiles at the border are moved
     * inwards. */
    vec2 center = min(vec2(first) + 0.5 * float(KILN_EDGE_TILE), vec2(size) - 0.5);
    vec2 tile = has_edges(first) ? center / vec2(size) * 2.0 - 1.0 : vec2(2.0);
    vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2)) * 2.0 - 1.0;
    gl_Position = vec4(at_edges ? tile : corner, 0.0, 1.0);
    gl_PointSize = float(KILN_EDGE_TILE);
}
