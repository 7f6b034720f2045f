/* Finds each body's closest partner, once a round. MOST_AROUND is for software GL, which ends long
 * loops early: bodies with more than MOST_AROUND others around get no partner, and the word behind
 * all cells gets the number of others, which lib/sim/crowd/interact_gl.c reports as an error. */
// variant:
// variant: KEYS_STORED=1
// variant: MOST_AROUND=65000u
#include "sim/crowd/interact.glsl"

#include "shared/interact_collide.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

/* 1: not the first round */
layout(location = INTERACT_AT_IS_LATER_ROUND) uniform uint is_later_round;

#ifdef MOST_AROUND

/* For each of the nine rows of cells around a body, the most bodies that any invocation of the
 * group looks at. The loops of all invocations run as long as the longest one. */
shared uint row_most[9];

uint count_around(uint self)
{
    EXACT float3 p = body_position(bodies[self]);
    int x = cell_along(p.x, interact_params.cells_per_metre);
    int y = cell_along(p.y, interact_params.cells_per_metre);
    int z = cell_along(p.z, interact_params.cells_per_metre);
    if (gl_LocalInvocationID.x == 0u)
        for (int row = 0; row < 9; row++)
            row_most[row] = 0u;
    barrier();
    for (int row = 0; row < 9; row++) {
        uint start = cell_row(y + row % 3 - 1, z + row / 3 - 1);
        uint first = cell_in_row(start, x - 1);
        uint last = cell_in_row(start, x + 1);
        uint behind = last < first ? body_count() : 0u;
        atomicMax(row_most[row], behind + cell_ends[last] - cell_begin(first));
    }
    barrier();
    uint sum = 0u;
    for (int row = 0; row < 9; row++)
        sum += row_most[row];
    return sum;
}

#endif

void main()
{
    uint self = invocation();
#ifdef MOST_AROUND
    uint around = count_around(min(self, max(body_count(), 1u) - 1u));
    if (around > MOST_AROUND) {
        atomicMax(cell_ends[interact_params.cell_mask + 1u], around);
        if (self < body_count())
            partners[self] = INTERACT_NOBODY;
        return;
    }
#endif
    if (self >= body_count())
        return;
    if (is_later_round != 0u && partners[self] == INTERACT_NOBODY)
        return;
    uint partner = contact_find(self);
    partners[self] = is_later_round != 0u ? contact_later(partner) : partner;
}
