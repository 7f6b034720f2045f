/* Estimates the steps and the memory that a run of a whole clip takes, from its scene alone. */
#ifndef KILN_SCENE_WORK_H
#define KILN_SCENE_WORK_H

#include "scene/options.h"

/* Returns the number of steps up to the last moment of the last frame. */
uint64_t kiln_work_steps(const struct kiln_scene *scene);
uint64_t kiln_work_particles(const struct kiln_scene *scene);

/* Estimates the bytes that rendering on the device cpu takes, within a factor of 1.5 for the scenes
 * of this project (docs/measurements.md), without encoders of video. */
uint64_t kiln_work_memory(const struct kiln_scene *scene);

/* Refuses a scene that needs more than its budget allows, with KILN_OVER_LIMIT and the place. */
bool kiln_work_check(struct kiln_reader *reader, const struct kiln_node *root);

/* Returns the result of kiln_scene_get_info. */
struct kiln_scene_info kiln_scene_facts(const struct kiln_scene *scene);

#endif
