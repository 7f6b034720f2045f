/* Before a sort: slots of the kept order become keys and ranks. Slots without a particle come last,
 * wherever they were: so a birth enters the order from its end, and nothing is lost or listed twice.
 */
#include "shared/keys.h"
#include "sort/kept.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

layout(std430, binding = SORT_BIND_RECORDS) readonly buffer record_block
{
    kiln_particle records[];
};

layout(location = 0) uniform uint slots; /* of the pool; what follows is padding */
layout(location = 6) uniform vec3 eye;     /* m */
layout(location = 7) uniform vec3 forward; /* unit length */

void main()
{
    uint i = group_index() * SORT_GROUP_SIZE + gl_LocalInvocationID.x;
    if (i >= slots) /* nothing sorts padding to another place */
        return;
    uint slot = pairs[i].y;
    uvec3 system = kept_systems[kept_system_of(slot)];
    uint place = slot - system.x;
    uint rank = place >= system.z ? place - system.z : place + (system.y - system.z);
    kiln_particle p = records[slot];
    uint key = 0xffffffffu;
    if (particle_is_alive(p))
        key = key_of_particle(p, eye, forward);
    pairs[i] = uvec2(key, system.x + rank);
}
