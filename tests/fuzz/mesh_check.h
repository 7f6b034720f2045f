/* Checks, for the fuzz targets, meshes that kiln's readers accepted: sizes are within the limits,
 * vertices are finite, and triangles have only vertices that exist. The same must hold for every
 * pose of a skinned mesh. */
#ifndef KILN_FUZZ_MESH_CHECK_H
#define KILN_FUZZ_MESH_CHECK_H

#include <math.h>

#include "asset/geometry/material.h"
#include "asset/geometry/rig.h"
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

/* Checks a mesh that was loaded with its materials. */
static inline void check_looks(const struct kiln_mesh *mesh)
{
    const struct kiln_mesh_looks *looks = mesh->looks;
    check_mesh(mesh);
    require(looks != NULL, "a mesh without its materials");
    require(looks->material_count <= KILN_MAX_MATERIALS &&
                looks->texture_count <= KILN_MAX_TEXTURES,
            "materials beyond the limits");
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        require(looks->of_triangles[i] == KILN_NO_MATERIAL ||
                    looks->of_triangles[i] < looks->material_count,
                "a triangle without its material");
    for (uint32_t i = 0; i < looks->material_count; i++) {
        for (int k = 0; k < KILN_MATERIAL_USES; k++)
            require(looks->materials[i].maps[k].texture == KILN_NO_TEXTURE ||
                        looks->materials[i].maps[k].texture < looks->texture_count,
                    "a map without its texture");
    }
    for (uint32_t i = 0; i < looks->texture_count; i++)
        require(kiln_path_stays_below(looks->textures[i].file) &&
                    looks->textures[i].first_byte <= looks->byte_count &&
                    looks->textures[i].byte_count <=
                        looks->byte_count - looks->textures[i].first_byte,
                "a texture that lies elsewhere");
    for (uint32_t i = 0; looks->colors && i < mesh->vertex_count; i++) {
        for (int c = 0; c < 4; c++)
            require(looks->colors[i][c] >= 0 && looks->colors[i][c] <= 1, "a colour beyond 1");
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

/* Checks the poses of a rig's first nodes at rest and at four times of its first clip. */
static inline void check_rig(const struct kiln_rig *rig)
{
    struct kiln_error error = {0};
    for (int number = 0; number < 8; number++) {
        char text[2] = {(char)('0' + number), '\0'};
        uint32_t node = 0;
        if (!kiln_rig_find_node(rig, text, number & 1, "fuzz", &node, &error))
            continue;
        for (int i = -1; i < 4; i++) {
            const bool moves = i >= 0 && kiln_rig_clip_count(rig) > 0;
            const float seconds = moves ? kiln_rig_clip_length(rig, 0) * (float)i / 3.0f : 0.0f;
            const struct kiln_rig_moment moment = {.clip = moves ? 0 : KILN_RIG_AT_REST,
                                                   .seconds = seconds,
                                                   .rate_seconds = seconds,
                                                   .rate_is_behind = i & 1,
                                                   .clip_s_each_s = 1000};
            const struct kiln_rig_pose pose = kiln_rig_pose_at(rig, node, &moment);
            double fov;
            (void)kiln_rig_camera_of(rig, node, &fov);
            struct kiln_rig_scale scale;
            require(!kiln_rig_find_scale(rig, node, moment.clip, &scale) || scale.taken > 0,
                    "a scale that is taken");
            require(pose.scale > 0 && isfinite(pose.scale) && isfinite(pose.growth), "a scale");
            for (int c = 0; c < 3; c++)
                require(isfinite(pose.at[c]) && isfinite(pose.ahead[c]) && isfinite(pose.up[c]) &&
                            isfinite(pose.velocity[c]) && isfinite(pose.spin[c]),
                        "a pose that is not finite");
        }
    }
}

#endif
