/* Technique `texels`: copies all slots from the textures to the records; with FROM_RECORDS, from
 * the records to the textures. */
// variant:
// variant: FROM_RECORDS=1
#include "shared/particle.h"
#include "sim/step/papers/texels.glsl"

layout(local_size_x = SIM_GROUP_SIZE) in;

layout(rgba32ui, binding = 0) uniform uimage2D positions;
layout(rgba32ui, binding = 1) uniform uimage2D velocities;

layout(std430, binding = SIM_BIND_RECORDS) buffer record_block
{
    kiln_particle records[];
};

layout(location = SIM_AT_SLOTS) uniform uint slots;

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint slot = group * SIM_GROUP_SIZE + gl_LocalInvocationID.x;
    if (slot >= slots)
        return;
    ivec2 at = texel_of(slot);
#ifdef FROM_RECORDS
    imageStore(positions, at, records[slot].position_serial);
    imageStore(velocities, at, records[slot].velocity_birth);
#else
    records[slot].position_serial = imageLoad(positions, at);
    records[slot].velocity_birth = imageLoad(velocities, at);
#endif
}
