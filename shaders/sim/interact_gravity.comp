/* Second: each adds up the pull of all, a tile of them at a time, which a work group shares. */
#include "sim/interact.glsl"

#include "shared/interact_gravity.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

shared uvec4 tile[SIM_GROUP_SIZE];

void main()
{
    uint slot = invocation();
    uint used = interact_params.used;
    uint me = gl_LocalInvocationID.x;
    uvec4 words = slot < used ? entries[slot] : uvec4(0u);
    EXACT float3 place =
        FLOAT3(BITS_FLOAT(words.x), BITS_FLOAT(words.y), BITS_FLOAT(words.z));
    EXACT float3 sum = FLOAT3(0.0f, 0.0f, 0.0f);
    for (uint first = 0u; first < used; first += uint(SIM_GROUP_SIZE)) {
        tile[me] = first + me < used ? entries[first + me] : uvec4(0u);
        barrier();
        for (uint i = 0u; i < uint(SIM_GROUP_SIZE); i++) {
            uvec4 other = tile[i];
            EXACT float4 source = FLOAT4(BITS_FLOAT(other.x), BITS_FLOAT(other.y),
                                         BITS_FLOAT(other.z), BITS_FLOAT(other.w));
            sum = gravity_add(sum, place, source, interact_params.softening_square);
        }
        barrier();
    }
    if (slot >= used)
        return;
    if (!particle_is_alive(records[interact_params.base + slot]))
        return;
    uint at = (interact_params.first_push + slot) * 2u;
    push_words[at] = gravity_push(push_words[at], sum, interact_params.derived.dt_s);
}
