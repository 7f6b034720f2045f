/* Second: where the bodies of each cell begin, by one work group. */
#include "shared/limits.h"

layout(local_size_x = INTERACT_SCAN_GROUP) in;

#define GROUP_SIZE INTERACT_SCAN_GROUP
#include "shared/group_sum.glsl"

layout(std430, binding = INTERACT_BIND_CELLS) buffer cell_block
{
    uint cells[];
};

layout(location = 0) uniform uint count;

void main()
{
    uint stretch = (count + uint(INTERACT_SCAN_GROUP) - 1u) / uint(INTERACT_SCAN_GROUP);
    uint first = min(gl_LocalInvocationID.x * stretch, count);
    uint last = min(first + stretch, count);
    uint sum = 0u;
    for (uint i = first; i < last; i++)
        sum += cells[i];
    uint before = group_sum_before(sum);
    for (uint i = first; i < last; i++) {
        uint bodies = cells[i];
        cells[i] = before;
        before += bodies;
    }
}
