/* Turns the ranks of the kept order back into slots after a sort. A slot means the same after the
 * next births; a rank does not. */
#include "sort/papers/spread.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

layout(location = SORT_AT_COUNT) uniform uint slots;

void main()
{
    uint i = group_index() * SORT_GROUP_SIZE + gl_LocalInvocationID.x;
    if (i >= slots)
        return;
    uint rank = pairs[i].y;
    uvec3 system = pool_systems[pool_system_of(rank)];
    uint place = rank - system.x + system.z;
    pairs[i].y = system.x + (place >= system.y ? place - system.y : place);
}
