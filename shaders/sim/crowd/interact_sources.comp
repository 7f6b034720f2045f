/* Writes place and strength of each slot as a source of gravity; an empty slot has strength 0. It
 * is the first kernel of gravity. */
#include "sim/crowd/interact.glsl"

#include "shared/interact_gravity.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint slot = invocation();
    if (slot >= interact_params.used)
        return;
    kiln_particle p = records[interact_params.base + slot];
    EXACT float4 source = particle_is_alive(p) ? gravity_source(p) : gravity_no_source();
    entries[slot] = uvec4(FLOAT_BITS(source.x), FLOAT_BITS(source.y), FLOAT_BITS(source.z),
                          FLOAT_BITS(source.w));
}
