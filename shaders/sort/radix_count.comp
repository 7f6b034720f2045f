/* Counts how often each digit occurs in each tile. */
// variant: RADIX_BITS=8 RADIX_GROUP_SIZE=16 RADIX_ITEMS=256
// variant: RADIX_BITS=6 RADIX_GROUP_SIZE=64 RADIX_ITEMS=32
#include "sort/radix.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

void main()
{
    count_digits();
    for (uint digit = gl_LocalInvocationID.x; digit < RADIX_DIGITS; digit += RADIX_GROUP_SIZE) {
        uint sum = 0u;
        for (uint i = 0u; i < RADIX_GROUP_SIZE; i++)
            sum += columns[digit * ROW + i];
        if (group_index() < tiles)
            counts[digit * tiles + group_index()] = sum;
    }
}
