/* A kiln_instances holds the meshes that particles are drawn as. The triangles of single particles
 * are never stored: each particle is placed while it is drawn (shared/instance.h), so memory grows
 * with the number of particles. */
#ifndef KILN_DRAW_MOMENT_INSTANCES_H
#define KILN_DRAW_MOMENT_INSTANCES_H

#include "scene/scene.h"

enum { KILN_INSTANCE_LARGEST_TILE = 64 }; /* texels along an edge */

/* Describes the mesh of one system. */
struct kiln_instance_mesh {
    uint32_t first;     /* corner */
    uint32_t triangles; /* 0: its particles are no meshes */
    float reach;        /* from the middle to the farthest corner */
};

/* Holds the meshes of all systems. The longest edge of the bounding box of each mesh has length 1,
 * and its middle is the origin. */
struct kiln_instances {
    struct kiln_instance_mesh meshes[KILN_MAX_SYSTEMS];
    float4 (*corners)[2]; /* of all meshes, three a triangle: position; normal. NULL: no meshes */
    uint32_t corner_count;
};

/* Makes the meshes of the scene's systems; KILN_DEVICE_FAILED when memory is short.
 * kiln_instances_finish then frees what was made. */
bool kiln_instances_init(struct kiln_instances *instances, const struct kiln_scene *scene,
                         struct kiln_error *error);
void kiln_instances_finish(struct kiln_instances *instances);

/* Returns the texels along an edge of the tile for the silhouette of each particle that is a mesh,
 * as the sun sees it. The edge is a power of two, and smaller where particles are many. 0: the
 * scene has no tiles, since no particles are meshes or too many are. */
uint32_t kiln_instance_tile_edge(const struct kiln_scene *scene);

#endif
