/* This file checks and counts the depth maps of a mesh that particles collide with. */
#include "scene/papers/depth_maps.h"

#include "asset/geometry/papers/depth_maps.h"
#include "scene/papers/papers.h"

void kiln_object_depth_directions(const struct kiln_object *mesh,
                                  float directions[KILN_MAX_DEPTH_DIRECTIONS][3])
{
    for (uint32_t i = 0; i < mesh->depth_direction_count; i++) {
        directions[i][0] = mesh->depth_directions[i].x.constant;
        directions[i][1] = mesh->depth_directions[i].y.constant;
        directions[i][2] = mesh->depth_directions[i].z.constant;
    }
}

static bool check(const struct kiln_object *mesh, struct kiln_error *error)
{
    float directions[KILN_MAX_DEPTH_DIRECTIONS][3];
    kiln_object_depth_directions(mesh, directions);
    return kiln_depth_maps_check(mesh->collision_mesh, mesh->file, (const float(*)[3])directions,
                                 mesh->depth_direction_count, mesh->depth_resolution, error);
}

static bool count(const struct kiln_scene *scene, const struct kiln_object *mesh, size_t *samples,
                  struct kiln_error *error)
{
    (void)scene;
    (void)error;
    *samples = kiln_depth_maps_words(mesh->depth_direction_count, mesh->depth_resolution);
    return true;
}

const struct kiln_mesh_grid kiln_mesh_grid_depth_maps = {.check = check, .count = count};
