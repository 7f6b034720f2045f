/* Computes the particles of a system at a time within a step, a slot in each invocation
 * (lib/draw/moment/between_gl.c). */
// variant:
// variant: SPINS=1
#include "shared/draw_layout.h"

layout(std140, binding = KILN_BIND_KEYS) uniform key_block { float4 value_keys[KILN_MAX_VALUE_KEYS]; };
#include "shared/between.h"
#include "shared/look_layout.h"

layout(local_size_x = 64) in;

layout(std140, binding = KILN_BIND_LOOKS) uniform look_block { kiln_draw_look looks[KILN_MAX_SYSTEMS]; };
layout(std430, binding = 0) readonly buffer before_block { kiln_particle before[]; };
layout(std430, binding = 1) readonly buffer after_block { kiln_particle after[]; };
layout(std430, binding = 2) writeonly buffer between_block { kiln_particle between[]; };
#ifdef SPINS
layout(std430, binding = 3) readonly buffer spin_before_block { kiln_spin spins_before[]; };
layout(std430, binding = 4) readonly buffer spin_after_block { kiln_spin spins_after[]; };
layout(std430, binding = 5) writeonly buffer spin_between_block { kiln_spin spins_between[]; };
#endif

layout(location = 0) uniform uint system;
layout(location = 1) uniform uint base; /* the system's first slot */
layout(location = 2) uniform uint used; /* slots that have held a particle */
layout(location = 3) uniform uint step_number; /* the step that the time is in */
layout(location = 4) uniform float back;       /* from the time to the step's end, in steps */
layout(location = 5) uniform uint first_spin;

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
