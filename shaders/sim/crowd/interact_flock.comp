/* Steers the bodies of a flock: each looks at its neighbours, and its acceleration becomes its
 * push. It is the last kernel of a flock. */
#include "sim/crowd/interact.glsl"

#include "shared/interact_flock.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint self = invocation();
    if (self >= body_count())
        return;
    EXACT flock_means means;
    means.position =
        FLOAT3(BITS_FLOAT(entries[0].x), BITS_FLOAT(entries[0].y), BITS_FLOAT(entries[0].z));
    means.velocity =
        FLOAT3(BITS_FLOAT(entries[1].x), BITS_FLOAT(entries[1].y), BITS_FLOAT(entries[1].z));
    flock_sums sums = flock_no_sums();
    if (interact_params.flock.looks != 0u)
        sums = flock_look(self);
    kiln_body body = bodies[self];
    uint at = (interact_params.first_push + body.velocity_slot.w) * 2u;
    EXACT float3 acceleration = flock_acceleration(body, sums, means);
    push_words[at] = flock_push(push_words[at], body, acceleration);
}
