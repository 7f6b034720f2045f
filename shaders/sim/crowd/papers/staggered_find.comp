/* Finds each body's closest partner in the two staggered grids, once a round. */
#include "sim/crowd/papers/staggered.glsl"

layout(local_size_x = SIM_GROUP_SIZE) in;

/* 1: not the first round */
layout(location = INTERACT_AT_IS_LATER_ROUND) uniform uint is_later_round;

void main()
{
    uint self = invocation();
    if (self >= body_count())
        return;
    if (is_later_round != 0u && partners[self] == INTERACT_NOBODY)
        return;
    uint partner = stagger_find(self, body_count());
    partners[self] = is_later_round != 0u ? contact_later(partner) : partner;
}
