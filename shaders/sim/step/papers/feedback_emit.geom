/* Technique `feedback` (Heinz 2019, 3.3.3, algorithm 3.1, lines 3 to 8): an emitter writes new
 * particles. The thesis has one emitter. A geometry shader writes a limited number of vertices, so
 * here each emitter spawns SIM_EMITTER_BIRTHS of the step's births, and the host draws as many
 * emitters as that takes. */
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

layout(points) in;
layout(points, max_vertices = SIM_EMITTER_BIRTHS) out;

#include "sim/step/papers/feedback.glsl"

void main()
{
    uint first = vertices[0].number * SIM_EMITTER_BIRTHS;
    uint end = min(first + SIM_EMITTER_BIRTHS, step_params.birth_count);
    for (uint birth = first; birth < end; birth++) {
        uint to_wrap = step_params.capacity - step_params.first_slot;
        uint slot = birth < to_wrap ? step_params.first_slot + birth : birth - to_wrap;
        kiln_particle p = slot_after(slot, step_dead());
        if (particle_is_there(p))
            write_particle(p);
    }
}
