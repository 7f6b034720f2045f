/* Fills the list up to a power of two with pairs that come after all others. */
#include "sort/network.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

layout(location = SORT_AT_COUNT) uniform uint count; /* pairs of the list */
layout(location = SORT_AT_PADDED) uniform uint padded;

void main()
{
    uint i = count + group_index() * SORT_GROUP_SIZE + gl_LocalInvocationID.x;
    if (i < padded)
        pairs[i] = uvec2(0xffffffffu, i);
}
