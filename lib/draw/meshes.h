/* The backdrop's meshes, as they are in their files, and its terrain. */
#ifndef KILN_DRAW_MESHES_H
#define KILN_DRAW_MESHES_H

#include "asset/mesh.h"
#include "scene/scene.h"

/* In the scene's order. */
struct kiln_meshes {
    uint32_t count;
    struct kiln_mesh *loaded[KILN_MAX_MESHES];
};

/* KILN_INVALID_INPUT and the rest as kiln_mesh_load and kiln_terrain_create; kiln_meshes_finish
 * then frees what there is. */
bool kiln_meshes_init(struct kiln_meshes *meshes, const struct kiln_scene *scene,
                      struct kiln_error *error);
void kiln_meshes_finish(struct kiln_meshes *meshes);

#endif
