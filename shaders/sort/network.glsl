/* Declares the pairs that sorting networks order, and compares them. No two pairs are equal, since
 * no two have the same place in the list that is sorted; so the order is that of a stable sort. */
#ifndef KILN_SORT_NETWORK_GLSL
#define KILN_SORT_NETWORK_GLSL

#include "shared/sort_layout.h"
#include "sort/index.glsl"

layout(std430, binding = SORT_BIND_PAIRS) buffer pair_block
{
    uvec2 pairs[];
};

bool is_after(uvec2 a, uvec2 b)
{
    return a.x > b.x || (a.x == b.x && a.y > b.y);
}

void order(inout uvec2 a, inout uvec2 b, bool descending)
{
    bool swaps = is_after(a, b) != descending;
    uvec2 first = swaps ? b : a;
    b = swaps ? a : b;
    a = first;
}

/* Returns the index of the first of 2^levels pairs at the given spacing, a power of two, for
 * invocation i. */
uint first_of(uint i, uint spacing, uint levels)
{
    return ((i & ~(spacing - 1u)) << levels) + (i & (spacing - 1u));
}

#endif
