/* Draws a point for each tile of the picture, for the second pass of backdrop.frag. The point
 * covers the tile if two neighbouring pixels hit different surfaces; otherwise it lies outside of
 * the picture. */
#include "shared/draw_layout.h"

layout(binding = 0) uniform sampler2D surfaces;

void main()
{
    ivec2 size = textureSize(surfaces, 0);
    int columns = (size.x + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    ivec2 first = ivec2(gl_VertexID % columns, gl_VertexID / columns) * KILN_EDGE_TILE;
    float largest_step = 0.0;
    float above[KILN_EDGE_TILE + 2];
    for (int y = -1; y <= KILN_EDGE_TILE; y++) {
        float before = 0.0;
        for (int x = -1; x <= KILN_EDGE_TILE; x++) {
            ivec2 at = clamp(first + ivec2(x, y), ivec2(0), size - 1);
            float surface = texelFetch(surfaces, at, 0).r;
            if (x >= 0)
                largest_step = max(largest_step, abs(surface - before));
            if (y >= 0)
                largest_step = max(largest_step, abs(surface - above[x + 1]));
            above[x + 1] = before = surface;
        }
    }
    /* GL draws a point only if its centre is in the picture, so tiles at the border are moved
     * inwards. */
    vec2 center = min(vec2(first) + 0.5 * float(KILN_EDGE_TILE), vec2(size) - 0.5);
    vec2 ndc = center / vec2(size) * 2.0 - 1.0;
    gl_Position = largest_step > KILN_EDGE_THRESHOLD ? vec4(ndc, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = float(KILN_EDGE_TILE);
}
