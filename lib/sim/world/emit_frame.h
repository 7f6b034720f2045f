/* Declares the frames of nodes and meshes during a step: particles are born in them, or move with
 * them. */
#ifndef KILN_SIM_WORLD_EMIT_FRAME_H
#define KILN_SIM_WORLD_EMIT_FRAME_H

#include "scene/scene.h"
#include "shared/layout.h"

/* Returns the frame of the node, or of the mesh of the backdrop, that an emitter lies in, during a
 * step, from 1. It is exact at both ends of the step; in
 * between, places lie on a cubic that also has the frame's velocity at both ends, and rotations go
 * about one axis, the way round that the frame's spin tells. What jumps within the step goes on as
 * before until the step's end (kiln_node_step_at). */
struct kiln_emit_frame kiln_emit_frame(const struct kiln_scene *scene,
                                       const struct kiln_emitter *emit, uint32_t step);

/* Returns how a node carries particles in a step, from 1. At the end of the step, they are where
 * the node is, also if it jumps. */
struct kiln_carry kiln_carry_frame(const struct kiln_scene *scene, uint32_t node, uint32_t step);

#endif
