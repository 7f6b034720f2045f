/* Technique `inplace` (Heinz 2019, algorithm 3.2): each invocation steps its slot in place, in one
 * buffer. The thesis finds free slots by an atomic counter. Here the host says which slots are born
 * into, so the order does not depend on scheduling. */
// variant:
// variant: FAMILY=1
// variant: GRIDS=1
// variant: GRIDS=1 SOURCES=1
// variant: GRIDS=1 FAMILY=1
// variant: COLLIDE_RUB=1
// variant: GRIDS=1 FAMILY=1 COLLIDE_RUB=1
// variant: COLLIDE_FIELD=1 GRIDS=1
// variant: COLLIDE_DEPTH=1 COLLIDE_FIELD=1 GRIDS=1
// variant: PUSHES=1 COLLIDE_FIELD=1 GRIDS=1 FAMILY=1
// variant: COLLIDE_VOLUME=1
// variant: PUSHES=1 COLLIDE_VOLUME=1 COLLIDE_FIELD=1 GRIDS=1 FAMILY=1
// variant: PUSHES=1
// variant: SPINS=1 PUSHES=1 COLLIDE_RUB=1
// variant: SPINS=1 PUSHES=1 COLLIDE_FIELD=1 GRIDS=1 FAMILY=1 COLLIDE_RUB=1
// variant: PUSHES=1 GRIDS=1 FAMILY=1
// variant: FORCES_ALL=1
// variant: FORCES_ALL=1 FAMILY=1
// variant: FORCES_ALL=1 GRIDS=1
// variant: FORCES_ALL=1 GRIDS=1 FAMILY=1
// variant: KEYS_STORED=1
// variant: KEYS_STORED=1 GRIDS=1 FAMILY=1
// variant: SURROUNDINGS_STORED=1
// variant: SWEEP_ALL=1
// variant: USES_KEYS=0u USES_FORCES=0u USES_EMITTERS=1u USES_COLLIDERS=0u USES_COLLIDE=0u USES_BIRTHS=1u USES_INTEGRATION=0u
// variant: FAMILY=1 USES_KEYS=4u USES_FORCES=1u USES_EMITTERS=8u USES_COLLIDERS=1u USES_COLLIDE=2u USES_BIRTHS=3u USES_INTEGRATION=0u
// variant: SWEEP_ALL=1 FORCES_ALL=1 GRIDS=1 FAMILY=1 PUSHES=1
#include "sim/step/slot.glsl"

layout(local_size_x = SIM_GROUP_SIZE) in;

layout(std430, binding = SIM_BIND_RECORDS) buffer record_block
{
    kiln_particle records[];
};

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint slot = group * SIM_GROUP_SIZE + gl_LocalInvocationID.x;
    if (slot >= step_params.used)
        return;
    uint index = step_params.base + slot;
    records[index] = slot_after(slot, records[index]);
}
