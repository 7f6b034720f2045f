/* This file makes the distance field of a mesh that particles collide with (shared/collide_sdf.h).
 */
#include "asset/geometry/field.h"
#include "base/cache.h"
#include "scene/samples.h"
#include "shared/exact.h"
#include "sim/world/mesh_row.h"

static void *create(const struct kiln_scene *scene, const struct kiln_object *mesh,
                    struct kiln_threads *threads, struct kiln_error *error)
{
    char cache[KILN_PATH_SIZE];
    const bool cached = kiln_cache_folder(cache);
    return kiln_field_create(mesh->collision_mesh, mesh->file, mesh->cells,
                             kiln_scene_field_reach(scene, mesh), cached ? cache : NULL, threads,
                             error);
}

static void destroy(void *source)
{
    struct kiln_field *field = source;
    kiln_field_destroy(&field);
}

static const float (*words(const void *source, size_t *count))[4]
{
    const struct kiln_field *field = source;
    *count = (size_t)field->size[0] * field->size[1] * field->size[2];
    return (const float(*)[4])field->samples;
}

static struct kiln_grid place(const void *source, size_t first)
{
    const struct kiln_field *field = source;
    const float *at = field->origin;
    const float per_unit = exact_canon(1.0f / field->spacing);
    return (struct kiln_grid){
        .origin = FLOAT4(exact_canon(at[0]), exact_canon(at[1]), exact_canon(at[2]), 0.0f),
        .per_metre = FLOAT4(per_unit, per_unit, per_unit, 0.0f),
        .size = {field->size[0], field->size[1], field->size[2], (uint)first}};
}

static void extent(const struct kiln_grid *grid, float half[3], float low[3])
{
    const float per_unit[3] = {grid->per_metre.x, grid->per_metre.y, grid->per_metre.z};
    const float origin[3] = {grid->origin.x, grid->origin.y, grid->origin.z};
    const uint samples[3] = {grid->size.x, grid->size.y, grid->size.z};
    for (int c = 0; c < 3; c++) {
        half[c] = 0.5f * (float)(samples[c] - 1) / per_unit[c];
        low[c] = origin[c];
    }
}

const struct kiln_mesh_row kiln_mesh_field_row = {.kind = COLLIDER_SDF,
                                                  .create = create,
                                                  .destroy = destroy,
                                                  .words = words,
                                                  .place = place,
                                                  .extent = extent};
