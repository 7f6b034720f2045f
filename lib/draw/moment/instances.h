/* The meshes that particles look like, ready to be drawn. */
#ifndef KILN_DRAW_MOMENT_INSTANCES_H
#define KILN_DRAW_MOMENT_INSTANCES_H

#include "scene/scene.h"

enum { KILN_INSTANCE_LARGEST_TILE = 64 }; /* texels along an edge */

/* Of one system. */
struct kiln_instance_mesh {
    uint32_t first;     /* corner */
    uint32_t triangles; /* 0: its particles are no meshes */
    float reach;        /* from the middle to the farthest corner */
};

/* The longest edge of the box around each mesh is 1 long, and its middle lies in the origin. */
struct kiln_instances {
    struct kiln_instance_mesh meshes[KILN_MAX_SYSTEMS];
    float4 (*corners)[2]; /* of all, three a triangle: position; normal. NULL: there are none */
    uint32_t corner_count;
};

/* Of the scene's systems; KILN_DEVICE_FAILED when memory is short.
 * kiln_instances_finish then frees what there is. */
bool kiln_instances_init(struct kiln_instances *instances, const struct kiln_scene *scene,
                         struct kiln_error *error);
void kiln_instances_finish(struct kiln_instances *instances);

/* Texels along an edge of the tile that the silhouette of each such particle gets, as the sun sees
 * it, a power of two: many particles have smaller ones. 0: a scene has no tiles, for no particles
 * are meshes or too many. */
uint32_t kiln_instance_tile_edge(const struct kiln_scene *scene);

#endif
