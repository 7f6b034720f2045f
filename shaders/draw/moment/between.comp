/* Computes the particles of a system at a time within a step, a slot in each invocation
 * (lib/draw/moment/between.c). */
// variant:
// variant: SPINS=1
#include "shared/draw_layout.h"

layout(std140, binding = KILN_BIND_KEYS) uniform key_block { float4 value_keys[KILN_BLOCK_KEYS]; };
#include "shared/between.h"
#include "shared/look_layout.h"

layout(local_size_x = 64) in;

layout(std140, binding = KILN_BIND_LOOKS) uniform look_block { kiln_draw_look looks[KILN_MAX_SYSTEMS]; };
layout(std430, binding = BETWEEN_BIND_BEFORE) readonly buffer before_block { kiln_particle before[]; };
layout(std430, binding = BETWEEN_BIND_AFTER) readonly buffer after_block { kiln_particle after[]; };
layout(std430, binding = BETWEEN_BIND_BETWEEN) writeonly buffer between_block { kiln_particle between[]; };
#ifdef SPINS
layout(std430, binding = BETWEEN_BIND_SPIN_BEFORE) readonly buffer spin_before_block { kiln_spin spins_before[]; };
layout(std430, binding = BETWEEN_BIND_SPIN_AFTER) readonly buffer spin_after_block { kiln_spin spins_after[]; };
layout(std430, binding = BETWEEN_BIND_SPIN_BETWEEN) writeonly buffer spin_between_block { kiln_spin spins_between[]; };
#endif

layout(location = BETWEEN_AT_SYSTEM) uniform uint system;
layout(location = BETWEEN_AT_BASE) uniform uint base; /* the system's first slot */
layout(location = BETWEEN_AT_USED) uniform uint used; /* slots that have held a particle */
layout(location = BETWEEN_AT_STEP) uniform uint step_number; /* the step that the time is in */
/* from the time to the step's end, in steps */
layout(location = BETWEEN_AT_BACK) uniform float back;
layout(location = BETWEEN_AT_FIRST_SPIN) uniform uint first_spin;

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint i = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (i >= used)
        return;
    kiln_derived_params derived = looks[system].derived;
    uint slot = base + i;
    between[slot] = particle_between(derived, before[slot], after[slot], step_number, back);
#ifdef SPINS
    uint spin = first_spin + i;
    spins_between[spin] = spin_between(after[slot], spins_before[spin], spins_after[spin],
                                       derived.dt_s, back);
#endif
}
