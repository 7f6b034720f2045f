/* Writes the push of each particle: the difference between its body after all rounds and the
 * particle itself. It is the last kernel of collisions. */
// variant:
// variant: SPINS=1
#include "sim/crowd/interact.glsl"

#include "shared/interact_body.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint self = invocation();
    if (self >= body_count())
        return;
    uint slot = bodies[self].velocity_slot.w;
    uint at = (interact_params.first_push + slot) * 2u;
    body_push push = body_push_of(bodies[self], records[interact_params.base + slot]);
    push_words[at] = push.velocity;
    push_words[at + 1u] = push.position;
#ifdef SPINS
    if (interact_params.spins != 0u)
        spin_words[spin_word(slot)] = bodies[interact_params.used + self].position_radius;
#endif
}
