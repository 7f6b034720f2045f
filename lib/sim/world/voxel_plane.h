/* Makes the plane that a cell of a volume keeps of a triangle. */
#ifndef KILN_SIM_WORLD_VOXEL_PLANE_H
#define KILN_SIM_WORLD_VOXEL_PLANE_H

#include "sim/world/voxels.h"

/* Makes the plane of a triangle, with a place on it near the middle of the cell, m. */
struct kiln_voxel kiln_voxel_plane(const struct kiln_voxels_input *in, uint32_t triangle,
                                   const double middle[3]);

#endif
