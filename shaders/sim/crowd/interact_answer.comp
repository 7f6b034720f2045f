/* Lets bodies collide that are each other's closest partners, once a round. Each of the two
 * computes its own change, so no invocation writes another's body. */
// variant:
// variant: SPINS=1
#include "sim/crowd/interact.glsl"

#include "shared/interact_collide.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint self = invocation();
    if (self >= body_count())
        return;
#ifdef SPINS
    if (interact_params.spins != 0u) {
        contact_turning after = contact_after_turning(self);
        bodies_after[self] = after.body;
        bodies_after[interact_params.used + self].position_radius = spin_words_of(after.rate);
        return;
    }
#endif
    bodies_after[self] = contact_after(self);
}
