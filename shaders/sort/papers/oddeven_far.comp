/* Runs one pass of the odd-even merge sort over the whole buffer of pairs. */
#include "sort/papers/oddeven.glsl"

layout(local_size_x = NETWORK_GROUP_SIZE) in;

layout(location = SORT_AT_COUNT) uniform uint count; /* a power of two */
layout(location = SORT_AT_STAGE) uniform uint stage;
layout(location = SORT_AT_DISTANCE) uniform uint distance;

void main()
{
    uint i = group_index() * NETWORK_GROUP_SIZE + gl_LocalInvocationID.x;
    uint low;
    if (i >= count / 2u || !comparison(i, stage, distance, low))
        return;
    uvec2 a = pairs[low];
    uvec2 b = pairs[low + distance];
    if (is_after(a, b)) {
        pairs[low] = b;
        pairs[low + distance] = a;
    }
}
