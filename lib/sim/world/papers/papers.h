/* Declares the grids of meshes that no scene takes unless it asks for them. They are there to be
 * compared with the papers that describe them. */
#ifndef KILN_SIM_WORLD_PAPERS_H
#define KILN_SIM_WORLD_PAPERS_H

#include "sim/world/mesh_row.h"

extern const struct kiln_mesh_row kiln_mesh_depth_maps_row; /* depth_maps.c */

#endif
