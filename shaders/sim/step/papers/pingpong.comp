/* Technique `pingpong` (Heinz 2019, 3.3.4, the unoptimised compute shader): reads one buffer and
 * writes another. The thesis appends to the target by an atomic counter. Here a slot's particle, or
 * an empty record, goes to the same slot of the target, so no result depends on scheduling. */
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
// variant: SWEEP_ALL=1
// variant: SWEEP_ALL=1 FORCES_ALL=1 GRIDS=1 FAMILY=1 PUSHES=1
#include "shared/papers/step_layout.h"
#include "sim/step/slot.glsl"

layout(local_size_x = SIM_GROUP_SIZE) in;

layout(std430, binding = SIM_BIND_RECORDS) readonly buffer record_block
{
    kiln_particle records[];
};

layout(std430, binding = SIM_BIND_SECOND) writeonly buffer second_block
{
    kiln_particle moved[];
};

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint slot = group * SIM_GROUP_SIZE + gl_LocalInvocationID.x;
    if (slot >= step_params.used)
        return;
    uint index = step_params.base + slot;
    moved[index] = slot_after(slot, records[index]);
}
