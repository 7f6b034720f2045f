/* What follows from sorted entries: bodies in the order of the first grid, and their entries for the
 * second; with SECOND, the order of that one. */
// variant:
// variant: SPINS=1
// variant: SECOND=1
#include "sim/crowd/interact.glsl"

#include "shared/interact_staggered.h"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint place = invocation();
    if (place >= body_count())
        return;
    uint what = entries[place].z;
#ifdef SECOND
    body_order[place] = what;
    body_order[interact_params.used + what] = place;
#else
    kiln_body body = body_of(records[interact_params.base + what], what);
    EXACT float3 position = body_position(body);
    stagger_key key = stagger_key_of(position, 0.5f);
    bodies[place] = body;
#ifdef SPINS
    note_turning(place, what);
#endif
    entries[place] = uvec4(key.high, key.low, place, 0u);
#endif
}
