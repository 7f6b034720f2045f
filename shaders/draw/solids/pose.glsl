/* How a particle has turned: by collisions, or by rotation and spin about an axis of its own. After
 * draw/moment/record.glsl. */
#include "shared/instance.h"

#ifdef SPINS
layout(std430, binding = KILN_BIND_SPINS) readonly buffer spin_block { kiln_spin spins[]; };

/* In a slot of the pool, of a system that collisions turn. */
vec4 pose_of_slot(uint system, uint slot)
{
    return spin_unit(spin_pose(spins[looks[system].turn.y + slot].pose));
}
#endif
