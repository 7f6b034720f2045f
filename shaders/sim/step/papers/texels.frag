/* Technique `texels` (Heinz 2019, 2.2.3; UberFlow, 4.1 and 4.2; Drone 2007, 7.3.1): a particle is a
 * texel of two textures, and a fragment shader reads it and writes its next state into two
 * others. */
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

/* Values are evaluated without loops: with a loop for each value of a fragment shader, llvmpipe's
 * compiler needs minutes. */
#define VALUE_UNROLLED 1

#include "shared/papers/step_layout.h"
#include "sim/step/slot.glsl"

layout(binding = 0) uniform usampler2D positions;
layout(binding = 1) uniform usampler2D velocities;

layout(location = 0) out uvec4 position_serial;
layout(location = 1) out uvec4 velocity_birth;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint index = uint(at.y) * uint(SIM_TEXEL_ROW) + uint(at.x);
    uint slot = index - step_params.base;
    if (index < step_params.base || slot >= step_params.used)
        discard; /* the slot belongs to another system, which has its own pass */
    kiln_particle old;
    old.position_serial = texelFetch(positions, at, 0);
    old.velocity_birth = texelFetch(velocities, at, 0);
    kiln_particle after = slot_after(slot, old);
    position_serial = after.position_serial;
    velocity_birth = after.velocity_birth;
}
