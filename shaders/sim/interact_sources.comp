/* First of gravity's kernels: where everybody is, and how strongly they pull. */
#include "sim/interact.glsl"

#include "shared/interact_gravity.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint slot = invocation();
    if (slot >= interact_params.used)
        return;
    if (interact_params.adds == 0u) {
        uint at = (interact_params.first_push + slot) * 2u;
        push_words[at] = float4(0.0f);
        push_words[at + 1u] = float4(0.0f);
    }
    kiln_particle p = records[interact_params.base + slot];
    EXACT float4 source = particle_is_alive(p) ? gravity_source(p) : gravity_no_source();
    entries[slot] = uvec4(FLOAT_BITS(source.x), FLOAT_BITS(source.y), FLOAT_BITS(source.z),
                          FLOAT_BITS(source.w));
}
