/* As inplace.comp, for systems that are related to others: a child finds its birth in the trace that
 * its parent has left in this step. Parents are dispatched before their children. */
// variant: 
// variant: COLLIDE_ROUND=1
#include "sim/blocks.h"

#include "shared/step_family.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

layout(std430, binding = SIM_BIND_RECORDS) buffer record_block
{
    kiln_particle records[];
};

layout(std430, binding = SIM_BIND_TRACES) buffer trace_block
{
    kiln_trace traces[];
};

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint slot = group * SIM_GROUP_SIZE + gl_LocalInvocationID.x;
    if (slot >= step_params.used)
        return;
    kiln_trace parent = trace_nothing();
    if (step_params.family.born_of != BORN_OF_CLOCK)
        parent = traces[family_parent_trace(slot)];
    uint index = step_params.base + slot;
    step_result after = step_family_slot(slot, records[index], parent);
    records[index] = after.particle;
    if (step_params.family.traced != 0u)
        traces[step_params.family.traces + slot] = after.trace;
}
