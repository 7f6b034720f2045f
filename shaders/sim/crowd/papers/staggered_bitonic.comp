/* Runs one pass of a bitonic merge sort over the entries of the staggered grids (UberFlow 2004,
 * 4.3.2). Entries are ordered by their cell and then by their slot or body, so no two are equal. */
#include "shared/papers/interact_layout.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

layout(std430, binding = INTERACT_BIND_ENTRIES) buffer entry_block
{
    uvec4 entries[];
};

layout(location = INTERACT_AT_ENTRY_COUNT) uniform uint count; /* a power of two */
layout(location = INTERACT_AT_RUN) uniform uint run; /* length of a run; every other run descends */
/* between two entries that are compared */
layout(location = INTERACT_AT_DISTANCE) uniform uint distance;

bool is_before(uvec4 a, uvec4 b)
{
    return a.x < b.x || (a.x == b.x && (a.y < b.y || (a.y == b.y && a.z < b.z)));
}

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint pair = group * SIM_GROUP_SIZE + gl_LocalInvocationID.x;
    uint low = (pair & ~(distance - 1u)) * 2u + (pair & (distance - 1u));
    uint high = low + distance;
    if (high >= count)
        return;
    uvec4 a = entries[low];
    uvec4 b = entries[high];
    bool descends = (low & run) != 0u;
    if (is_before(b, a) != descends) {
        entries[low] = b;
        entries[high] = a;
    }
}
