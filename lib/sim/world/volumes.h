/* Makes the volumes of meshes (render-to-volume; Drone 2007, 7.5.2). Particles collide with such a
 * mesh as planes in the cells of a lattice, which are found anew in each step. */
#ifndef KILN_SIM_WORLD_VOLUMES_H
#define KILN_SIM_WORLD_VOLUMES_H

#include "base/footprint.h"
#include "base/thread.h"
#include "gpu/buffer.h"
#include "scene/scene.h"
#include "shared/layout.h"

struct kiln_volume;

struct kiln_volumes {
    uint32_t count;
    struct kiln_volume *items[KILN_MAX_MESHES];
    uint32_t of_object[KILN_MAX_OBJECTS]; /* number of an object's volume, if it has one */
    /* float4: marks and planes, which shared/collide_volume.h looks up */
    struct kiln_buffer words;
};

/* Returns whether an object needs a volume. */
bool kiln_volumes_needs(const struct kiln_object *object);

/* Creates the volumes of a scene. device NULL: for the host. KILN_DEVICE_FAILED when memory is
 * short. kiln_volumes_finish frees everything, also after a failure. */
bool kiln_volumes_init(struct kiln_volumes *volumes, struct kiln_device *device,
                       const struct kiln_scene *scene, struct kiln_error *error);

/* Adds the memory of the volumes of a scene on the host. */
void kiln_volumes_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_volumes_finish(struct kiln_volumes *volumes);

/* Makes the volumes of a step; the result is the same for any number of threads. Meshes that do not
 * move keep their volume. KILN_DEVICE_FAILED when memory is short. */
bool kiln_volumes_step(struct kiln_volumes *volumes, const struct kiln_scene *scene, uint32_t step,
                       struct kiln_threads *threads, struct kiln_error *error);

/* Returns an object's collider in the last step made, but for its kind. Its lattice goes into the
 * table of grids, in which volumes begin at `first`. */
struct kiln_collider kiln_volumes_collider(const struct kiln_volumes *volumes, uint32_t object,
                                           uint32_t first, struct kiln_grid table[KILN_MAX_GRIDS]);

/* Returns how many cells have planes in the last step made; *cells: how many cells there are. */
uint32_t kiln_volumes_planes(const struct kiln_volumes *volumes, uint32_t *cells);

#endif
