/* Writes the samples of a baked wind, one an invocation (Heinz 2019, 2.2.5). The step's parameters
 * have the forces that are summed up. */
// variant:
// variant: FORCES_ALL=1
// variant: KEYS_STORED=1 SURROUNDINGS_STORED=1
// variant: FORCES_ALL=1 USES_KEYS=0u USES_CLOCKS=0u USES_FORCES=136u USES_INTEGRATION=0u
#define GRIDS         1
#define GRIDS_WRITTEN 1
#include "sim/step/blocks.h"

#include "shared/bake.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

layout(location = SIM_AT_GRID) uniform uint grid;
layout(location = SIM_AT_NODE) uniform vec4 node_at; /* of struct kiln_still_frame */
layout(location = SIM_AT_NODE_TURN) uniform vec4 node_turn;

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint index = group * SIM_GROUP_SIZE + gl_LocalInvocationID.x;
    kiln_grid g = surroundings.grids[grid];
    if (index >= g.size.x * g.size.y * g.size.z)
        return;
    kiln_still_frame node = kiln_still_frame(node_at, node_turn);
    grid_words[g.size.w + index] = bake_sample(g, node, index);
}
