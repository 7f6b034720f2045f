/* Chooses where on a mesh or a picture a particle is born. A source is a list of cells: triangles,
 * vertices or pixels. A cell is chosen by Walker's alias method (Vose 1991), which takes two random
 * numbers whatever the number of cells. The choice depends on the particle's random numbers alone,
 * so drawing finds the same cell again, and its colour, from the record of the particle.
 *
 * Cell i is chosen with the share `share` of its turns, and otherwise cell `other` is. */
#ifndef KILN_SHARED_SOURCE_H
#define KILN_SHARED_SOURCE_H

#include "shared/random.h"

/* Words of the cells in the buffer of the grids. Those of a triangle are a corner and the share,
 * the way to the second corner and `other`, and the way to the third; of a mesh with an animation,
 * the change of all three during the step follows. Those of a vertex are its
 * place and the share, and its normal and `other`. Those of a column of the inside of a mesh are
 * the middle of its lower end and the share, and its length and `other`. That of a pixel has x and
 * y of its lower left corner, the share and `other`. Those of a path are places at equal distances
 * along it. */
#define SOURCE_TRIANGLE_WORDS 3u
#define SOURCE_POSED_WORDS    6u
#define SOURCE_VERTEX_WORDS   2u
#define SOURCE_COLUMN_WORDS   2u
#define SOURCE_PIXEL_WORDS    1u

/* Texels in a row of the texture that has the colours of sources. */
#define SOURCE_ROW 1024

/* Returns the part of `count` that 32 bits are of 2^32, rounded down: the high word of the
 * product. */
FN uint source_part(uint bits, uint count)
{
    uint low = (bits & 0xffffu) * (count & 0xffffu);
    uint middle = (bits >> 16u) * (count & 0xffffu) + (low >> 16u);
    uint other = (bits & 0xffffu) * (count >> 16u) + (middle & 0xffffu);
    return (bits >> 16u) * (count >> 16u) + (middle >> 16u) + (other >> 16u);
}

/* Returns the cell whose turn it is. */
FN uint source_turn(uint stream, uint count)
{
    return source_part(random_bits(stream, RANDOM_PLACE), count);
}

/* Returns the cell that is chosen: `turn`, or the other cell of that turn. */
FN uint source_choose(uint stream, uint turn, float share, uint other)
{
    EXACT float drawn = random_unit(stream, RANDOM_PLACE + 1u);
    return drawn < share ? turn : other;
}

/* A place in a cell. On a pixel, both are parts of its edges; on a triangle, parts of the ways from
 * the first corner to the others, of which the sum is at most 1. */
struct source_spot {
    float s, t;
};

FN S(source_spot) source_spot_on_pixel(uint stream)
{
    EXACT S(source_spot) spot;
    spot.s = random_unit(stream, RANDOM_PLACE + 2u);
    spot.t = random_unit(stream, RANDOM_PLACE + 3u);
    return spot;
}

/* Returns a place that is uniform on a triangle: a parallelogram is folded along its diagonal. */
FN S(source_spot) source_spot_on_triangle(uint stream)
{
    EXACT S(source_spot) spot = source_spot_on_pixel(stream);
    EXACT float sum = spot.s + spot.t;
    if (sum > 1.0f) {
        spot.s = 1.0f - spot.s;
        spot.t = 1.0f - spot.t;
    }
    return spot;
}

/* Returns which of the colours of a triangle is that of a place. A triangle has `rows` rows of
 * colours, each one shorter than the row before. */
FN uint source_color_of(S(source_spot) spot, uint rows)
{
    EXACT float row = spot.s * FLOAT(rows);
    EXACT float column = spot.t * FLOAT(rows);
    uint i = UINT(row);
    i = i < rows ? i : rows - 1u;
    uint j = UINT(column);
    uint last = rows - 1u - i;
    j = j < last ? j : last;
    return i * rows - ((i * (i - 1u)) >> 1u) + j;
}

/* Returns a component of a colour, whose root has 10 bits: component 0 is red. */
FN float source_component(uint color, uint component)
{
    EXACT float root = FLOAT((color >> (10u * component)) & 1023u) * 9.77517106e-4f;
    EXACT float linear_light = root * root;
    return linear_light;
}

#endif
