/* Finds the orientation of particles that collisions turn. Vertex shaders of opaque particles
 * include it after draw/moment/record.glsl; shared/instance.h has the orientation by rotation and
 * spin about an axis of the particle's own. */
#include "shared/instance.h"

#ifdef SPINS
layout(std430, binding = KILN_BIND_SPINS) readonly buffer spin_block { kiln_spin spins[]; };

/* Returns the pose, a unit quaternion, of the particle in a slot of the pool. Its system must be
 * one that collisions turn. */
vec4 pose_of_slot(uint system, uint slot)
{
    return spin_unit(spin_pose(spins[looks[system].turn.y + slot].pose));
}
#endif
