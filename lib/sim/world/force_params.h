/* Declares how the host makes the parameters of a force: its values at one time, and the frame of
 * its node. */
#ifndef KILN_SIM_WORLD_FORCE_PARAMS_H
#define KILN_SIM_WORLD_FORCE_PARAMS_H

#include "scene/scene.h"
#include "sim/world/grids.h"

/* A moment of a system, for which the host evaluates values. */
struct kiln_sim_moment {
    const struct kiln_scene *scene;
    uint32_t system;
    float time_s;
};

/* Returns the clip time at which the host evaluates the forces of a step, from 1. */
float kiln_sim_forces_s(const struct kiln_scene *scene, uint32_t step);

/* Returns a constant for a value that is the same for all particles; another one stays as it is. */
struct kiln_value kiln_sim_value_at(const struct kiln_sim_moment *moment, struct kiln_value value);

/* Returns the frame of the node that something is attached to, at a clip time. What is not attached
 * has none. */
struct kiln_still_frame kiln_sim_frame(const struct kiln_scene *scene,
                                       const struct kiln_attach *attach, float time_s);

/* Returns the parameters of a force in a moment. */
struct kiln_force_params kiln_sim_force_params(const struct kiln_sim_moment *moment,
                                               const struct kiln_sim_grids *grids,
                                               const struct kiln_force *force);

#endif
