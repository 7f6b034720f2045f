/* Counts one digit of the keys in a tile of pairs. Every invocation owns a stretch of the tile and
 * a column of counters, one for each digit, so no two invocations change one counter. The host
 * defines RADIX_BITS of a digit, RADIX_GROUP_SIZE invocations of a tile and RADIX_ITEMS pairs of
 * each. */
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

layout(location = SORT_AT_COUNT) uniform uint count;
layout(location = SORT_AT_SHIFT) uniform uint shift; /* lowest bit of the digit in a key */
layout(location = SORT_AT_TILES) uniform uint tiles;

/* A row has one word more than it needs, so that invocations that walk along rows access different
 * banks of shared memory. */
#define ROW uint(RADIX_GROUP_SIZE + 1)
shared uint columns[RADIX_DIGITS * ROW];

uint stretch_begin()
{
    return group_index() * RADIX_TILE + gl_LocalInvocationID.x * RADIX_ITEMS;
}

/* Returns the index of this invocation's counter for the digit of a key. */
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
