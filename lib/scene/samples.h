/* Counts the samples of the grids that move particles or that particles collide with: wind files,
 * baked winds, terrain, depth maps and distance fields (sim/world/grids.h makes them). */
#ifndef KILN_SCENE_SAMPLES_H
#define KILN_SCENE_SAMPLES_H

#include "scene/options.h"

/* Declares a kind of grids that are made of meshes before the first step, so that particles collide
 * with them: what a scene must know of it. */
struct kiln_mesh_grid {
    /* Returns false with KILN_INVALID_INPUT if a grid would take too long to make. NULL: none does.
     */
    bool (*check)(const struct kiln_object *mesh, struct kiln_error *error);
    /* Counts the samples of a grid. Returns false with an error if the mesh can have none. */
    bool (*count)(const struct kiln_scene *scene, const struct kiln_object *mesh, size_t *samples,
                  struct kiln_error *error);
};

/* Returns what a scene must know of the grid of a mesh by its collider; NULL: it has no such grid.
 */
const struct kiln_mesh_grid *kiln_mesh_grid_of(enum kiln_collider_kind collider);

/* Reads wind files and fills scene->samples. Refuses faulty files, meshes of which no distance
 * field can be made, and more files or samples than a scene may have. root: as of kiln_validate,
 * whose other checks are done. */
bool kiln_samples_settle(struct kiln_reader *reader, const struct kiln_node *root);

/* Returns the largest distance from a mesh, in units of its file, at which the centre of a ball can
 * be that touches it. */
float kiln_scene_field_reach(const struct kiln_scene *scene, const struct kiln_object *mesh);

#endif
