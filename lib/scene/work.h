/* Counts the work that a run of a whole clip is, from its scene alone, and compares it and the
 * expected memory with a budget. */
#ifndef KILN_SCENE_WORK_H
#define KILN_SCENE_WORK_H

#include "scene/load.h"
#include "scene/options.h"

/* Returns the number of steps up to the last moment of the last frame. */
uint64_t kiln_work_steps(const struct kiln_scene *scene);
uint64_t kiln_work_particles(const struct kiln_scene *scene);

/* Return the slots of systems whose particles are opaque, of those of these that are meshes, and of
 * all others. Systems that are not enabled have none. */
uint64_t kiln_scene_solid_slots(const struct kiln_scene *scene);
uint64_t kiln_scene_mesh_slots(const struct kiln_scene *scene);
uint64_t kiln_scene_sprite_slots(const struct kiln_scene *scene);

/* Refuses a scene that needs more than its budget allows, with KILN_OVER_LIMIT and the place. Keeps
 * the expected memory, that of the program included, for kiln_scene_get_info. */
bool kiln_work_check(struct kiln_reader *reader, const struct kiln_node *root,
                     kiln_scene_estimate *estimate);

/* Returns the result of kiln_scene_get_info. */
struct kiln_scene_info kiln_scene_facts(const struct kiln_scene *scene);

#endif
