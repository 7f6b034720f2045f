/* Runs the passes of a bitonic sort (Heinz 2019, 2.4.1) whose comparisons stay within a block, in
 * shared memory. With FROM_START it sorts the block by merging bunches of 2 pairs and more;
 * otherwise it does the last passes of a larger bunch. Each invocation orders eight pairs at a
 * time, for three passes. Where fewer passes are left, it repeats some that are done, which changes
 * nothing. */
// variant:
// variant: FROM_START=1
// variant: FROM_START=1 NETWORK_GROUP_SIZE=512
#include "sort/bitonic.glsl"

layout(local_size_x = NETWORK_GROUP_SIZE) in;

layout(location = SORT_AT_COUNT) uniform uint count; /* a power of two */
/* pairs of a bunch, which is ordered in one direction */
layout(location = SORT_AT_BUNCH) uniform uint size;

shared uvec2 block[NETWORK_BLOCK];

void passes(uint first, uint bunch, uint spacing)
{
    uint at = first_of(gl_LocalInvocationID.x, spacing, 3u);
    bool descending = ((first + at) & bunch) != 0u;
    uvec2 p[8];
    for (uint i = 0u; i < 8u; i++)
        p[i] = block[at + i * spacing];
    order_far(p, descending);
    order_middle(p, descending, descending);
    order_near(p, bvec4(descending));
    for (uint i = 0u; i < 8u; i++)
        block[at + i * spacing] = p[i];
    barrier();
}

/* Merges bunches in the block, over all distances from half a bunch, or half the block, down to
 * 1. */
void merge(uint first, uint bunch)
{
    uint spacing = min(bunch, NETWORK_BLOCK) / 8u;
    for (; spacing > 1u; spacing = max(spacing / 8u, 1u))
        passes(first, bunch, spacing);
    passes(first, bunch, 1u);
}

/* Sorts bunches of 2, then 4, then 8 pairs. */
void sort_eight(uint first)
{
    uint at = gl_LocalInvocationID.x * 8u;
    uvec2 p[8];
    for (uint i = 0u; i < 8u; i++)
        p[i] = block[at + i];
    order_near(p, bvec4(false, true, false, true));
    order_middle(p, false, true);
    order_near(p, bvec4(false, false, true, true));
    bool descending = ((first + at) & 8u) != 0u;
    order_far(p, descending);
    order_middle(p, descending, descending);
    order_near(p, bvec4(descending));
    for (uint i = 0u; i < 8u; i++)
        block[at + i] = p[i];
    barrier();
}

void main()
{
    uint first = group_index() * NETWORK_BLOCK;
    for (uint i = gl_LocalInvocationID.x; i < NETWORK_BLOCK; i += NETWORK_GROUP_SIZE)
        block[i] = first + i < count ? pairs[first + i] : uvec2(0xffffffffu);
    barrier();
#ifdef FROM_START
    sort_eight(first);
    for (uint bunch = 16u; bunch <= NETWORK_BLOCK; bunch *= 2u)
        merge(first, bunch);
#else
    merge(first, size);
#endif
    for (uint i = gl_LocalInvocationID.x; i < NETWORK_BLOCK; i += NETWORK_GROUP_SIZE) {
        if (first + i < count)
            pairs[first + i] = block[i];
    }
}
