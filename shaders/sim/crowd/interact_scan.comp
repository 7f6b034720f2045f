/* Finds where the bodies of each cell begin, by an exclusive scan of the counts in one work group.
 * It is the second kernel of collisions and flocks. It takes four cells in an iteration, since
 * llvmpipe limits how often loops run, and a table may have 2^24 cells. */
#include "shared/limits.h"

layout(local_size_x = INTERACT_SCAN_GROUP) in;

#define GROUP_SIZE INTERACT_SCAN_GROUP
#include "shared/group_sum.glsl"

layout(std430, binding = INTERACT_BIND_CELLS) buffer cell_block
{
    uint cells[];
};

layout(location = INTERACT_AT_CELL_COUNT) uniform uint count;

uint bodies_of(uint cell, uint last)
{
    return cell < last ? cells[cell] : 0u;
}

/* Writes where the bodies of a cell begin, and returns where those of the next cell begin. */
uint begin_at(uint cell, uint last, uint before)
{
    uint bodies = bodies_of(cell, last);
    if (cell < last)
        cells[cell] = before;
    return before + bodies;
}

void main()
{
    uint stretch = (count + uint(INTERACT_SCAN_GROUP) - 1u) / uint(INTERACT_SCAN_GROUP);
    uint first = min(gl_LocalInvocationID.x * stretch, count);
    uint last = min(first + stretch, count);
    uint sum = 0u;
    for (uint i = first; i < last; i += 4u)
        sum += bodies_of(i, last) + bodies_of(i + 1u, last) + bodies_of(i + 2u, last) +
               bodies_of(i + 3u, last);
    uint before = group_sum_before(sum);
    for (uint i = first; i < last; i += 4u) {
        before = begin_at(i, last, before);
        before = begin_at(i + 1u, last, before);
        before = begin_at(i + 2u, last, before);
        before = begin_at(i + 3u, last, before);
    }
}
