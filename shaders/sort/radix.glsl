/* One digit of a tile of pairs: every invocation owns a stretch of the tile, and a column of
 * counters, one a digit, so that nothing is counted by two. The host says RADIX_BITS of a digit,
 * RADIX_GROUP_SIZE and RADIX_ITEMS of each invocation. */
#ifndef KILN_SORT_RADIX_GLSL
#define KILN_SORT_RADIX_GLSL

#include "shared/sort_layout.h"
#include "sort/index.glsl"

#define RADIX_DIGITS (1u << RADIX_BITS)
#define RADIX_TILE   uint(RADIX_GROUP_SIZE * RADIX_ITEMS)

layout(std430, binding = SORT_BIND_PAIRS) readonly buffer pair_block
{
    uvec2 pairs[];
};

layout(std430, binding = SORT_BIND_COUNTS) buffer count_block
{
    uint counts[]; /* by digit, then by tile */
};

layout(location = 0) uniform uint count;
layout(location = 1) uniform uint shift; /* of the digit */
layout(location = 2) uniform uint tiles;

/* One longer than a row needs, so that invocations that walk along rows meet no common bank. */
#define ROW uint(RADIX_GROUP_SIZE + 1)
shared uint columns[RADIX_DIGITS * ROW];

uint stretch_begin()
{
    return group_index() * RADIX_TILE + gl_LocalInvocationID.x * RADIX_ITEMS;
}

/* Index of this invocation's counter for a key. */
uint counter_of(uint key)
{
    return (key >> shift & (RADIX_DIGITS - 1u)) * ROW + gl_LocalInvocationID.x;
}

void count_digits()
{
    for (uint digit = 0u; digit < RADIX_DIGITS; digit++)
        columns[digit * ROW + gl_LocalInvocationID.x] = 0u;
    uint first = stretch_begin();
    for (uint i = 0u; i < RADIX_ITEMS; i++) {
        if (first + i < count)
            columns[counter_of(pairs[first + i].x)]++;
    }
    barrier();
}

#endif
