/* What bitonic sorting compares. Pairs are all different, since no two have the same place in the
 * list that is sorted: so the order is that of a stable sort.
 *
 * An invocation takes several pairs into registers and does the comparisons of several passes among
 * them, which saves most of the traffic with memory that a pass for each distance has.
 */
#ifndef KILN_SORT_BITONIC_GLSL
#define KILN_SORT_BITONIC_GLSL

#include "shared/sort_layout.h"
#include "sort/index.glsl"

layout(std430, binding = SORT_BIND_PAIRS) buffer pair_block
{
    uvec2 pairs[];
};

void order(inout uvec2 a, inout uvec2 b, bool descending)
{
    bool after = a.x > b.x || (a.x == b.x && a.y > b.y);
    bool swaps = after != descending;
    uvec2 first = swaps ? b : a;
    b = swaps ? a : b;
    a = first;
}

/* Index of the first of 2^levels pairs at the given spacing, a power of two, for invocation i. */
uint first_of(uint i, uint spacing, uint levels)
{
    return ((i & ~(spacing - 1u)) << levels) + (i & (spacing - 1u));
}

/* Passes over the distances 4, 2 and 1 times the spacing of eight pairs. */
void order_far(inout uvec2 p[8], bool descending)
{
    for (uint i = 0u; i < 4u; i++)
        order(p[i], p[i + 4u], descending);
}

void order_middle(inout uvec2 p[8], bool first_descending, bool second_descending)
{
    for (uint i = 0u; i < 2u; i++) {
        order(p[i], p[i + 2u], first_descending);
        order(p[i + 4u], p[i + 6u], second_descending);
    }
}

void order_near(inout uvec2 p[8], bvec4 descending)
{
    for (uint i = 0u; i < 4u; i++)
        order(p[2u * i], p[2u * i + 1u], descending[i]);
}

#endif
