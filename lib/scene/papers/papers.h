/* Declares the ways in which particles collide with meshes that no scene takes unless it asks for
 * them. They are there to be compared with the papers that describe them. */
#ifndef KILN_SCENE_PAPERS_H
#define KILN_SCENE_PAPERS_H

#include "scene/samples.h"

extern const struct kiln_mesh_grid kiln_mesh_grid_depth_maps; /* depth_maps.c */

#endif
