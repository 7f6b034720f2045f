/* Checks, for the fuzz targets, meshes that kiln's readers accepted: sizes are within the limits,
 * vertices are finite, and triangles have only vertices that exist. The same must hold for every
 * pose of a skinned mesh. */
#ifndef KILN_FUZZ_MESH_CHECK_H
#define KILN_FUZZ_MESH_CHECK_H

#include <math.h>

#include "asset/geometry/skin.h"
#include "image_check.h"

static inline void check_mesh(const struct kiln_mesh *mesh)
{
    require(mesh->triangle_count >= 1 && mesh->triangle_count <= KILN_MAX_MESH_TRIANGLES &&
                mesh->vertex_count >= 3 && mesh->vertex_count <= KILN_MAX_MESH_VERTICES,
            "a mesh beyond the limits");
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        for (int c = 0; c < 6; c++)
            require(isfinite(mesh->vertices[i][c]), "a vertex is not finite");
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        for (int c = 0; c < 3; c++)
            require(mesh->triangles[i][c] < mesh->vertex_count, "a corner without a vertex");
    }
}

/* Checks a skinned mesh as it was loaded, and in the poses at four times of its first animation
 * clip, from its start to its end. */
static inline void check_skin(const struct kiln_skin *skin)
{
    struct kiln_mesh *mesh = kiln_mesh_copy(kiln_skin_mesh(skin));
    require(mesh != NULL, "no memory");
    const float length = kiln_skin_clip_length(skin, 0);
    for (int i = 0; i < 4; i++) {
        check_mesh(mesh);
        kiln_skin_pose_mesh(skin, 0, length * (float)i / 3.0f, mesh);
    }
    check_mesh(mesh);
    kiln_mesh_destroy(&mesh);
}

#endif
