/* Runs a pass of merge sort over long lists: two neighbouring runs, each in order, become one run
 * of twice the length. A fragment's place is the sum of its place in its own run and, by binary
 * search, its place in the other run. */
#include "draw/sprites/fragments.glsl"

layout(local_size_x = KILN_FRAGMENT_BLOCK) in;

layout(std430, binding = KILN_BIND_FRAGMENT_MERGED) writeonly buffer merged_block
{
    uvec4 merged_keys[];
};

layout(std430, binding = KILN_BIND_FRAGMENT_BLOCKS) readonly buffer block_block
{
    uvec2 blocks[];
};

layout(location = KILN_AT_FRAGMENT_BLOCK_COUNT) uniform uint block_count;
/* length of a run in fragments, a power of two */
layout(location = KILN_AT_FRAGMENT_RUN) uniform uint run;

/* Returns how many fragments between two places of the other run come before a key. Fragments of
 * the left run come before equal ones of the right run. */
uint count_before(uvec4 key, bool is_left, uint from, uint until)
{
    uint low = from, high = until;
    while (low < high) {
        uint middle = (low + high) / 2u;
        uvec4 other = list_keys[middle];
        if (is_left ? is_behind(other, key) : !is_behind(key, other))
            low = middle + 1u;
        else
            high = middle;
    }
    return low - from;
}

void main()
{
    uint block = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (block >= block_count)
        return;
    uint pixel = blocks[block].x, i = blocks[block].y + gl_LocalInvocationID.x;
    uint first = ranges[pixel].first, count = list_length(pixel);
    if (i >= count)
        return;
    uint left = i & ~(2u * run - 1u), middle = min(left + run, count), end = min(middle + run, count);
    bool is_left = i < middle;
    uvec4 key = list_keys[first + i];
    uint from = is_left ? middle : left, until = is_left ? end : middle;
    uint place = i - (is_left ? 0u : run) + count_before(key, is_left, first + from, first + until);
    merged_keys[first + place] = key;
}
