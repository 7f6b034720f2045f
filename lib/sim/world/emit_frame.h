/* Declares the frames of nodes during a step, from which particles are born. */
#ifndef KILN_SIM_WORLD_EMIT_FRAME_H
#define KILN_SIM_WORLD_EMIT_FRAME_H

#include "scene/scene.h"
#include "shared/layout.h"

/* Returns the frame of a node during a step, from 1. It is exact at both ends of the step; in
 * between, places lie on a cubic that also has the node's velocity at both ends, and rotations go
 * about one axis, the way round that the node's spin tells. What jumps within the step goes on as
 * before until the step's end (kiln_node_step_at). */
struct kiln_emit_frame kiln_emit_frame(const struct kiln_scene *scene, uint32_t node,
                                       uint32_t step);

#endif
