/* One point a tile of the picture: it covers the tile where two neighbouring pixels hit different
 * surfaces, and lies outside of the picture everywhere else.
 */
#include "shared/draw_layout.h"

layout(binding = 0) uniform sampler2D surfaces;

void main()
{
    ivec2 size = textureSize(surfaces, 0);
    int columns = (size.x + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    ivec2 first = ivec2(gl_VertexID % columns, gl_VertexID / columns) * KILN_EDGE_TILE;
    float surface = texelFetch(surfaces, min(first, size - 1), 0).r;
    float difference = 0.0;
    for (int y = -1; y <= KILN_EDGE_TILE; y++) {
        for (int x = -1; x <= KILN_EDGE_TILE; x++) {
            ivec2 at = clamp(first + ivec2(x, y), ivec2(0), size - 1);
            difference += abs(texelFetch(surfaces, at, 0).r - surface);
        }
    }
    /* A point is drawn only if its centre is in the picture: tiles at the border are pushed in. */
    vec2 center = min(vec2(first) + 0.5 * float(KILN_EDGE_TILE), vec2(size) - 0.5);
    vec2 ndc = center / vec2(size) * 2.0 - 1.0;
    gl_Position = difference > 0.0 ? vec4(ndc, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = float(KILN_EDGE_TILE);
}
