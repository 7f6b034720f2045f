/* Copies bodies into the order of the sorted entries of the first grid, and writes their entries
 * for the second grid. With SECOND, it writes the order of the second grid: the body at each place,
 * and the place of each body. */
// variant:
// variant: SPINS=1
// variant: SECOND=1
#include "sim/crowd/papers/staggered.glsl"

layout(local_size_x = SIM_GROUP_SIZE) in;

void main()
{
    uint place = invocation();
    if (place >= body_count())
        return;
    uint slot_or_body = entries[place].z;
#ifdef SECOND
    body_order[place] = slot_or_body;
    body_order[interact_params.used + slot_or_body] = place;
#else
    kiln_body body = body_of(records[interact_params.base + slot_or_body], slot_or_body);
    EXACT float3 position = body_position(body);
    stagger_key key = stagger_key_of(position, 0.5f);
    bodies[place] = body;
#ifdef SPINS
    copy_spin(place, slot_or_body);
#endif
    entries[place] = uvec4(key.high, key.low, place, 0u);
#endif
}
