/* Steps one slot, for kernels of every technique. FAMILY is for systems that are parents or
 * children of others: a child finds its birth in the trace that its parent has left in this step.
 * Parents are dispatched before their children. */
#ifndef KILN_SIM_SLOT_GLSL
#define KILN_SIM_SLOT_GLSL

#include "sim/step/blocks.h"

#ifdef FAMILY

#include "shared/step_family.h"

layout(std430, binding = SIM_BIND_TRACES) buffer trace_block
{
    kiln_trace traces[];
};

kiln_particle slot_after(uint slot, kiln_particle old)
{
    kiln_trace parent = trace_nothing();
    if (step_params.family.born_of != BORN_OF_CLOCK)
        parent = traces[family_parent_trace(slot)];
    step_result after = step_family_slot(slot, old, parent);
    if (step_params.family.traced != 0u)
        traces[step_params.family.traces + slot] = after.trace;
    return after.particle;
}

#else

#include "shared/step.h"

kiln_particle slot_after(uint slot, kiln_particle old)
{
    return step_slot(slot, old);
}

#endif
#endif
