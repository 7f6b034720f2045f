/* A kiln_instances holds the meshes that particles are drawn as. The triangles of a particle are
 * never stored: they are placed in the world while the particle is drawn (shared/instance.h). So
 * memory grows with the number of particles, not with the number of their triangles. */
#ifndef KILN_DRAW_MOMENT_INSTANCES_H
#define KILN_DRAW_MOMENT_INSTANCES_H

#include "base/footprint.h"
#include "scene/scene.h"

enum { KILN_INSTANCE_LARGEST_TILE = 64 }; /* texels along an edge */

/* Describes the mesh of the particles of one system. */
struct kiln_instance_mesh {
    uint32_t first;     /* index of the first corner in kiln_instances.corners */
    uint32_t triangles; /* number of triangles; 0: the system's particles are not meshes */
    float reach;        /* from the middle to the farthest corner; the longest edge is 1 */
};

/* Holds the meshes of all systems. Each mesh is scaled so that the longest edge of its bounding box
 * has length 1, and moved so that the middle of the box is the origin. */
struct kiln_instances {
    struct kiln_instance_mesh meshes[KILN_MAX_SYSTEMS];
    float4 (*corners)[2]; /* position and normal, three corners a triangle; NULL: no meshes */
    uint32_t corner_count;
};

/* Copies the meshes of the scene's systems. Returns false with KILN_DEVICE_FAILED when memory is
 * short; kiln_instances_finish must be called in that case, too. */
bool kiln_instances_init(struct kiln_instances *instances, const struct kiln_scene *scene,
                         struct kiln_error *error);

/* Adds the memory of the meshes of a scene's systems. */
void kiln_instances_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_instances_finish(struct kiln_instances *instances);

/* Returns the edge, in texels, of the tiles that hold the silhouettes of particles that are meshes,
 * as seen from the sun. It is a power of two, and smaller where there are many such particles.
 * Returns 0 when the scene has no tiles, since no particles are meshes or too many are. */
uint32_t kiln_instance_tile_edge(const struct kiln_scene *scene);

#endif
