/* Once a round: partners collide. Both compute it, each for itself. */
#include "sim/interact.glsl"

#include "shared/interact_collide.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint self = invocation();
    if (self < body_count())
        bodies_after[self] = contact_after(self);
}
