/* Once a round: each body's closest partner; with STAGGERED, as the paper finds it. */
// variant: 
// variant: STAGGERED=1
#include "sim/interact.glsl"

#include "shared/interact_staggered.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

layout(location = 0) uniform uint later; /* 1: not the first round */

void main()
{
    uint self = invocation();
    if (self >= body_count())
        return;
    if (later != 0u && partners[self] == INTERACT_NOBODY)
        return;
#ifdef STAGGERED
    uint partner = stagger_find(self, body_count());
#else
    uint partner = contact_find(self);
#endif
    partners[self] = later != 0u ? contact_later(partner) : partner;
}
