/* Finds edges in the picture of surface numbers that backdrop.frag draws first: changes between
 * neighbouring pixels. backdrop_edges.vert looks for them in tiles, backdrop.frag around pixels. */
layout(binding = 0) uniform sampler2D surfaces;

/* Returns whether two neighbours in a square of pixels show different surfaces. first: the square's
 * top left pixel; edge: of the square, at most KILN_EDGE_TILE + 2 px. Pixels beside the picture
 * repeat those at its border. */
bool has_edge(ivec2 first, int edge)
{
    ivec2 last = textureSize(surfaces, 0) - 1;
    float largest_step = 0.0;
    float above[KILN_EDGE_TILE + 2];
    for (int y = 0; y < edge; y++) {
        float before = 0.0;
        for (int x = 0; x < edge; x++) {
            ivec2 at = clamp(first + ivec2(x, y), ivec2(0), last);
            float surface = texelFetch(surfaces, at, 0).r;
            if (x > 0)
                largest_step = max(largest_step, abs(surface - before));
            if (y > 0)
                largest_step = max(largest_step, abs(surface - above[x]));
            above[x] = before = surface;
        }
    }
    return largest_step > KILN_EDGE_THRESHOLD;
}
