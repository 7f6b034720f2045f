/* Declares what lib/sim/world needs to make the depth maps of a mesh of a scene. */
#ifndef KILN_SCENE_PAPERS_DEPTH_MAPS_H
#define KILN_SCENE_PAPERS_DEPTH_MAPS_H

#include "scene/scene.h"

/* Computes the directions of the depth maps of a mesh. */
void kiln_object_depth_directions(const struct kiln_object *mesh,
                                  float directions[KILN_MAX_DEPTH_DIRECTIONS][3]);

#endif
