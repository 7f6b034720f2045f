/* Loads the grids that a scene's forces and colliders look up. They lie in one buffer; a table says
 * where each begins. */
#ifndef KILN_SIM_WORLD_GRIDS_H
#define KILN_SIM_WORLD_GRIDS_H

#include "base/thread.h"
#include "gpu/buffer.h"
#include "scene/scene.h"
#include "sim/world/volumes.h"

struct kiln_sim_grids {
    uint32_t count; /* files of wind first, then the objects that collide */
    uint32_t wind_count;
    const char *files[KILN_MAX_WINDS];    /* the scene's: what each shows */
    uint32_t of_object[KILN_MAX_OBJECTS]; /* number of an object's grid; else of no account */
    float top[KILN_MAX_GRIDS];            /* m: terrain's highest point */
    float steepest[KILN_MAX_GRIDS];       /* terrain's: see struct kiln_collider */
    struct kiln_grid table[KILN_MAX_GRIDS];
    struct kiln_buffer words; /* float4 */
    struct kiln_volumes volumes;
};

/* Loads what the scene names, each file once, and makes its terrain, distance fields and depth
 * maps, on the threads. device NULL: for the host. Errors are those of loading and making them.
 * After a failure, too, kiln_sim_grids_finish frees what there is. */
bool kiln_sim_grids_init(struct kiln_sim_grids *grids, struct kiln_device *device,
                         const struct kiln_scene *scene, struct kiln_threads *threads,
                         struct kiln_error *error);
void kiln_sim_grids_finish(struct kiln_sim_grids *grids);

/* Does the object need a grid that does not change during a run? */
bool kiln_sim_grids_needs(const struct kiln_object *object);

/* The number of the grid of a file of wind that the scene names. */
uint32_t kiln_sim_grids_find(const struct kiln_sim_grids *grids, const char *file);

#endif
