/* Writes the entries of a list in the order of their sorted pairs. */
#include "sort/network.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

layout(std430, binding = SORT_BIND_COUNTS) readonly buffer list_block
{
    uint list[];
};

layout(std430, binding = SORT_BIND_ENTRIES) writeonly buffer entry_block
{
    uint entries[];
};

layout(location = SORT_AT_COUNT) uniform uint count;
/* not 0: the pairs are read from their end */
layout(location = SORT_AT_REVERSE) uniform uint reverse;

void main()
{
    uint i = group_index() * SORT_GROUP_SIZE + gl_LocalInvocationID.x;
    if (i < count)
        entries[i] = list[pairs[reverse != 0u ? count - 1u - i : i].y];
}
