/* Adds up the pull of a range of sources on each particle, a tile of them at a time, which a work
 * group shares. It is the second kernel of gravity. Several dispatches, one for each range, add to
 * the same sums, since llvmpipe ends long loops early; the last one turns the sums into pushes. */
#include "sim/crowd/interact.glsl"

#include "shared/interact_gravity.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

layout(location = INTERACT_AT_FIRST_SOURCE) uniform uint first_source;
layout(location = INTERACT_AT_END_SOURCE) uniform uint end_source;
layout(location = INTERACT_AT_ALL_SOURCES) uniform uint all_sources;
layout(location = INTERACT_AT_SUMS) uniform uint sums_at; /* entry of the sum of the first slot */

shared uvec4 tile[SIM_GROUP_SIZE];

float3 sum_before(uint slot)
{
    uvec4 words = first_source > 0u ? entries[sums_at + slot] : uvec4(0u);
    EXACT float3 sum = FLOAT3(BITS_FLOAT(words.x), BITS_FLOAT(words.y), BITS_FLOAT(words.z));
    return sum;
}

void push(uint slot, bool alive, float3 acceleration)
{
    uint at = (interact_params.first_push + slot) * 2u;
    EXACT float4 before = FLOAT4(0.0f, 0.0f, 0.0f, 0.0f);
    if (interact_params.adds != 0u)
        before = push_words[at];
    else
        push_words[at + 1u] = float4(0.0f);
    push_words[at] =
        alive ? gravity_push(before, acceleration, interact_params.derived.dt_s) : before;
}

void main()
{
    uint lane = gl_LocalInvocationID.x;
    uint slot = min(invocation(), interact_params.used - 1u);
    bool is_padding = slot != invocation();
    kiln_particle p = records[interact_params.base + slot];
    EXACT float3 place = particle_position(p);
    EXACT float3 sum = sum_before(slot);
    for (uint first = first_source; first < end_source; first += uint(SIM_GROUP_SIZE)) {
        tile[lane] = first + lane < end_source ? entries[first + lane] : uvec4(0u);
        barrier();
        for (uint i = 0u; i < uint(SIM_GROUP_SIZE); i++) {
            uvec4 other = tile[i];
            EXACT float4 source = FLOAT4(BITS_FLOAT(other.x), BITS_FLOAT(other.y),
                                         BITS_FLOAT(other.z), BITS_FLOAT(other.w));
            sum = gravity_add(sum, place, source, interact_params.softening_square);
        }
        barrier();
    }
    if (is_padding)
        return;
    if (end_source < all_sources)
        entries[sums_at + slot] =
            uvec4(FLOAT_BITS(sum.x), FLOAT_BITS(sum.y), FLOAT_BITS(sum.z), 0u);
    else
        push(slot, particle_is_alive(p), sum);
}
