/* Turns the slots of the kept order into keys and ranks before a sort. Slots without a particle get
 * the last key, wherever they were. So a new particle enters the order from its end, and no slot is
 * lost or listed twice. */
#include "shared/keys.h"
#include "sort/papers/spread.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

layout(std430, binding = SORT_BIND_RECORDS) readonly buffer record_block
{
    kiln_particle records[];
};

/* slots of the pool; pairs behind them are padding */
layout(location = SORT_AT_COUNT) uniform uint slots;
layout(location = SORT_AT_EYE) uniform vec3 eye; /* m */
layout(location = SORT_AT_FORWARD) uniform vec3 forward; /* unit length */

void main()
{
    uint i = group_index() * SORT_GROUP_SIZE + gl_LocalInvocationID.x;
    if (i >= slots) /* padding keeps its place in the sort */
        return;
    uint slot = pairs[i].y;
    uvec3 system = pool_systems[pool_system_of(slot)];
    uint place = slot - system.x;
    uint rank = place >= system.z ? place - system.z : place + (system.y - system.z);
    kiln_particle p = records[slot];
    uint key = 0xffffffffu;
    if (particle_is_alive(p))
        key = key_of_particle(p, eye, forward);
    pairs[i] = uvec2(key, system.x + rank);
}
