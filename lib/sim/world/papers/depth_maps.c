/* This file makes the depth maps of a mesh that particles collide with
 * (shared/papers/collide_depth.h). */
#include "asset/geometry/papers/depth_maps.h"

#include "scene/papers/depth_maps.h"
#include "shared/exact.h"
#include "sim/world/papers/papers.h"

static void *create(const struct kiln_scene *scene, const struct kiln_object *mesh,
                    struct kiln_threads *threads, struct kiln_error *error)
{
    (void)scene;
    float directions[KILN_MAX_DEPTH_DIRECTIONS][3];
    kiln_object_depth_directions(mesh, directions);
    return kiln_depth_maps_create(mesh->collision_mesh, mesh->file, (const float(*)[3])directions,
                                  mesh->depth_direction_count, mesh->depth_resolution, threads,
                                  error);
}

static void destroy(void *source)
{
    struct kiln_depth_maps *maps = source;
    kiln_depth_maps_destroy(&maps);
}

static const float (*words(const void *source, size_t *count))[4]
{
    const struct kiln_depth_maps *maps = source;
    *count = maps->word_count;
    return (const float(*)[4])maps->words;
}

static float4 canon4(const float v[3])
{
    return FLOAT4(exact_canon(v[0]), exact_canon(v[1]), exact_canon(v[2]), 0.0f);
}

static struct kiln_grid place(const void *source, size_t first)
{
    const struct kiln_depth_maps *maps = source;
    return (struct kiln_grid){
        .low = canon4(maps->min),
        .high = canon4(maps->max),
        .size = {maps->resolution, maps->resolution, maps->count, (uint)first}};
}

static void extent(const struct kiln_grid *grid, float half[3], float low[3])
{
    const float least[3] = {grid->low.x, grid->low.y, grid->low.z};
    const float most[3] = {grid->high.x, grid->high.y, grid->high.z};
    for (int c = 0; c < 3; c++) {
        half[c] = 0.5f * (most[c] - least[c]);
        low[c] = least[c];
    }
}

const struct kiln_mesh_row kiln_mesh_depth_maps_row = {.kind = COLLIDER_DEPTH,
                                                       .create = create,
                                                       .destroy = destroy,
                                                       .words = words,
                                                       .place = place,
                                                       .extent = extent};
