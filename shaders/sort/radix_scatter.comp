/* Moves the pairs of a tile to the places that the scanned counts give. Pairs with equal digits
 * keep their order. The last pass writes only the entries of the pairs. */
// variant: RADIX_BITS=8 RADIX_GROUP_SIZE=16 RADIX_ITEMS=256
// variant: RADIX_BITS=6 RADIX_GROUP_SIZE=64 RADIX_ITEMS=32
// variant: RADIX_BITS=8 RADIX_GROUP_SIZE=16 RADIX_ITEMS=256 LAST=1
// variant: RADIX_BITS=6 RADIX_GROUP_SIZE=64 RADIX_ITEMS=32 LAST=1
#include "sort/radix.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

#ifdef LAST
layout(std430, binding = SORT_BIND_ENTRIES) writeonly buffer entry_block
{
    uint entries[];
};

/* not 0: the list is written from its end */
layout(location = SORT_AT_REVERSE) uniform uint reverse;
#else
layout(std430, binding = SORT_BIND_PAIRS_OUT) writeonly buffer pair_out_block
{
    uvec2 pairs_out[];
};
#endif

void main()
{
    count_digits();
    for (uint digit = gl_LocalInvocationID.x; digit < RADIX_DIGITS; digit += RADIX_GROUP_SIZE) {
        uint place = group_index() < tiles ? counts[digit * tiles + group_index()] : 0u;
        for (uint i = 0u; i < RADIX_GROUP_SIZE; i++) {
            uint here = columns[digit * ROW + i];
            columns[digit * ROW + i] = place;
            place += here;
        }
    }
    barrier();
    uint first = stretch_begin();
    for (uint i = 0u; i < RADIX_ITEMS; i++) {
        if (first + i < count) {
            uvec2 pair = pairs[first + i];
            uint at = counter_of(pair.x);
            uint place = columns[at];
            columns[at] = place + 1u;
#ifdef LAST
            entries[reverse != 0u ? count - 1u - place : place] = pair.y;
#else
            pairs_out[place] = pair;
#endif
        }
    }
}
