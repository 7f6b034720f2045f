/* Runs LEVELS passes of a bitonic sort, over distances that span blocks. An invocation has 2^LEVELS
 * pairs in registers. */
// variant: LEVELS=1
// variant: LEVELS=2
// variant: LEVELS=3
// variant: LEVELS=3 NETWORK_GROUP_SIZE=8
#include "sort/network.glsl"

layout(local_size_x = NETWORK_GROUP_SIZE) in;

#define PAIRS (1u << LEVELS)

layout(location = SORT_AT_COUNT) uniform uint count; /* a power of two */
/* pairs of a bunch, ordered in one direction */
layout(location = SORT_AT_BUNCH) uniform uint bunch;
layout(location = SORT_AT_DISTANCE) uniform uint spacing; /* the least distance of these passes */

void main()
{
    uint i = group_index() * NETWORK_GROUP_SIZE + gl_LocalInvocationID.x;
    if (i >= count / PAIRS)
        return;
    uint at = first_of(i, spacing, LEVELS);
    bool descending = (at & bunch) != 0u;
    uvec2 p[PAIRS];
    for (uint k = 0u; k < PAIRS; k++)
        p[k] = pairs[at + k * spacing];
    for (uint distance = PAIRS / 2u; distance > 0u; distance /= 2u)
        for (uint k = 0u; k < PAIRS / 2u; k++) {
            uint low = first_of(k, distance, 1u);
            order(p[low], p[low + distance], descending);
        }
    for (uint k = 0u; k < PAIRS; k++)
        pairs[at + k * spacing] = p[k];
}
