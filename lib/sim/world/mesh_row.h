/* Declares a kind of grids that are made of meshes once, before the first step, and move rigidly
 * with them: a row of the table in grids.c. */
#ifndef KILN_SIM_WORLD_MESH_ROW_H
#define KILN_SIM_WORLD_MESH_ROW_H

#include "base/thread.h"
#include "scene/scene.h"

struct kiln_mesh_row {
    uint kind; /* of struct kiln_collider */
    /* Makes a grid of a mesh. Returns NULL with an error. */
    void *(*create)(const struct kiln_scene *scene, const struct kiln_object *mesh,
                    struct kiln_threads *threads, struct kiln_error *error);
    void (*destroy)(void *source);
    /* Returns the words of the grid, and their number. */
    const float (*(*words)(const void *source, size_t *count))[4];
    /* Describes the grid for the step; its words begin at `first`. */
    struct kiln_grid (*place)(const void *source, size_t first);
    /* Finds the bounding box of the grid, in the frame of its mesh: half its size and its least
     * corner. */
    void (*extent)(const struct kiln_grid *grid, float half[3], float low[3]);
};

extern const struct kiln_mesh_row kiln_mesh_field_row; /* distance fields: mesh_field.c */

#endif
