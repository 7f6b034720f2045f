/* Finds edges in the picture of numbers that backdrop.frag draws first (shared/draw_layout.h):
 * backdrop.vert finds the tiles that may have some, backdrop.frag their pixels. Pixels beside
 * the picture repeat those at its border. */
#include "shared/shape_layout.h"

layout(binding = KILN_UNIT_SURFACES) uniform sampler2D surfaces;

float edge_number(ivec2 at)
{
    return texelFetch(surfaces, clamp(at, ivec2(0), textureSize(surfaces, 0) - 1), 0).r;
}

bool is_marked(float number)
{
    return number >= 0.5 * KILN_EDGE_MARK;
}

float without_mark(float number)
{
    return is_marked(number) ? number - KILN_EDGE_MARK : number;
}

/* Returns whether a pixel is marked, or differs from one of the eight pixels around it. A straight
 * edge that parts a pixel's area parts its middle from one of theirs. */
bool is_edge(ivec2 pixel)
{
    float number = edge_number(pixel), own = without_mark(number), largest_step = 0.0;
    for (int k = 0; k < 9; k++) {
        float other = without_mark(edge_number(pixel + ivec2(k % 3, k / 3) - 1));
        largest_step = max(largest_step, abs(other - own));
    }
    return is_marked(number) || largest_step > KILN_EDGE_THRESHOLD;
}

/* Returns whether no edge of light passes between a pixel and those around it: no two neighbours of
 * these nine are on one surface and differ. */
bool is_lit_evenly(ivec2 pixel)
{
    float numbers[9];
    bool even = true;
    for (int k = 0; k < 9; k++) {
        numbers[k] = without_mark(edge_number(pixel + ivec2(k % 3, k / 3) - 1));
        for (int other = 0; other < k; other++) {
            bool neighbors = k / 3 - other / 3 <= 1 && abs(k % 3 - other % 3) <= 1;
            float change = abs(numbers[k] - numbers[other]);
            even = even && (!neighbors || change <= KILN_EDGE_THRESHOLD ||
                            change > KILN_EDGE_MOST_LIGHT);
        }
    }
    return even;
}

/* Returns whether a tile may have pixels at edges: one is marked, or two neighbours in a row or a
 * column of the tile or of the pixels around it differ by half of the threshold, since two such
 * steps lead to a diagonal neighbour. first: the tile's top left pixel. */
bool has_edges(ivec2 first)
{
    float largest_step = 0.0;
    float above[KILN_EDGE_TILE + 2];
    bool marked = false;
    for (int y = 0; y < KILN_EDGE_TILE + 2; y++) {
        float before = 0.0;
        for (int x = 0; x < KILN_EDGE_TILE + 2; x++) {
            float number = edge_number(first + ivec2(x, y) - 1), own = without_mark(number);
            marked = marked || is_marked(number);
            if (x > 0)
                largest_step = max(largest_step, abs(own - before));
            if (y > 0)
                largest_step = max(largest_step, abs(own - above[x]));
            above[x] = before = own;
        }
    }
    return marked || largest_step > 0.5 * KILN_EDGE_THRESHOLD;
}
