/* Draws a point for each tile of the picture, for the second pass of backdrop.frag. The point
 * covers the tile if it may have pixels at edges; otherwise it lies outside of the picture. */
#include "shared/draw_layout.h"

#include "draw/backdrop/backdrop_edges.glsl"

void main()
{
    ivec2 size = textureSize(surfaces, 0);
    int columns = (size.x + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    ivec2 first = ivec2(gl_VertexID % columns, gl_VertexID / columns) * KILN_EDGE_TILE;
    /* GL draws a point only if its centre is in the picture, so tiles at the border are moved
     * inwards. */
    vec2 center = min(vec2(first) + 0.5 * float(KILN_EDGE_TILE), vec2(size) - 0.5);
    vec2 ndc = center / vec2(size) * 2.0 - 1.0;
    gl_Position = has_edges(first) ? vec4(ndc, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = float(KILN_EDGE_TILE);
}
