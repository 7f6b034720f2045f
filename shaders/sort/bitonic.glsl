/* Orders eight pairs that an invocation has in registers, for several passes of a bitonic sort.
 * This saves most of the memory traffic of a sort that runs a pass over memory for each
 * distance. */
#ifndef KILN_SORT_BITONIC_GLSL
#define KILN_SORT_BITONIC_GLSL

#include "sort/network.glsl"

/* order_far, order_middle and order_near compare pairs over distances of 4, 2 and 1 times the
 * spacing of the eight. */
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
