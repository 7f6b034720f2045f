/* This file loads or makes the grids of a scene (wind, terrain, distance fields and depth maps),
 * and puts them all into one buffer, on the host or in GL. */
#include "sim/world/grids.h"

#include <string.h>

#include "asset/geometry/depth_maps.h"
#include "asset/geometry/field.h"
#include "asset/geometry/grid_in.h"
#include "base/cache.h"
#include "base/error.h"
#include "scene/samples.h"
#include "shared/exact.h"

/* The sources of the grids in their order: winds, then objects. An object has a terrain, a field or
 * depth maps. */
struct sources {
    struct kiln_grid_file *winds[KILN_MAX_WINDS];
    struct kiln_terrain *terrains[KILN_MAX_MESHES];
    struct kiln_field *fields[KILN_MAX_MESHES];
    struct kiln_depth_maps *depths[KILN_MAX_MESHES];
};

uint32_t kiln_sim_grids_find(const struct kiln_sim_grids *grids, const char *file)
{
    uint32_t i = 0;
    while (i < grids->wind_count && strcmp(grids->files[i], file) != 0)
        i++;
    return i;
}

bool kiln_sim_grids_needs(const struct kiln_object *object)
{
    return object->collide && kiln_object_is_mesh(object) && !kiln_volumes_needs(object);
}

static void list_files(struct kiln_sim_grids *grids, const struct kiln_scene *scene)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        for (uint32_t k = 0; k < system->force_count; k++) {
            const char *file = system->forces[k].file;
            if (system->forces[k].kind == KILN_FORCE_FIELD &&
                kiln_sim_grids_find(grids, file) == grids->wind_count)
                grids->files[grids->wind_count++] = file;
        }
    }
    grids->count = grids->wind_count;
}

static float4 canon4(const float v[3])
{
    return FLOAT4(exact_canon(v[0]), exact_canon(v[1]), exact_canon(v[2]), 0.0f);
}

/* ---- loading --------------------------------------------------------------------------------- */

static struct kiln_depth_maps *make_depths(const struct kiln_mesh *mesh,
                                           const struct kiln_object *object,
                                           struct kiln_threads *threads, struct kiln_error *error)
{
    float directions[KILN_MAX_DEPTH_DIRECTIONS][3];
    kiln_object_depth_directions(object, directions);
    return kiln_depth_maps_create(mesh, object->file, (const float(*)[3])directions,
                                  object->depth_direction_count, object->depth_resolution, threads,
                                  error);
}

static bool make_mesh(struct sources *sources, uint32_t number, const struct kiln_scene *scene,
                      const struct kiln_object *object, struct kiln_threads *threads,
                      struct kiln_error *error)
{
    const struct kiln_mesh *mesh = object->collision_mesh;
    char cache[KILN_PATH_SIZE];
    const bool cached = kiln_cache_folder(cache);
    if (object->collider == KILN_COLLIDER_DEPTH_MAPS)
        sources->depths[number] = make_depths(mesh, object, threads, error);
    else
        sources->fields[number] = kiln_field_create(mesh, object->file, object->cells,
                                                    kiln_scene_field_reach(scene, object),
                                                    cached ? cache : NULL, threads, error);
    return sources->depths[number] || sources->fields[number];
}

static bool load_object(struct sources *sources, uint32_t number, const struct kiln_scene *scene,
                        const struct kiln_object *object, struct kiln_threads *threads,
                        struct kiln_error *error)
{
    if (object->kind == KILN_OBJECT_MESH)
        return make_mesh(sources, number, scene, object, threads, error);
    const struct kiln_terrain_params params = kiln_scene_terrain(scene, object);
    sources->terrains[number] = kiln_terrain_create(&params, error);
    return sources->terrains[number] != NULL;
}

static bool load(struct kiln_sim_grids *grids, const struct kiln_scene *scene,
                 struct sources *sources, struct kiln_threads *threads, struct kiln_error *error)
{
    for (uint32_t i = 0; i < grids->wind_count; i++) {
        sources->winds[i] = kiln_grid_load(scene->loader, grids->files[i], error);
        if (!sources->winds[i])
            return false;
    }
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        if (!kiln_sim_grids_needs(&scene->backdrop.objects[i]))
            continue;
        const uint32_t k = grids->count - grids->wind_count;
        if (!load_object(sources, k, scene, &scene->backdrop.objects[i], threads, error))
            return false;
        grids->of_object[i] = grids->count++;
    }
    return true;
}

static void free_sources(struct sources *sources)
{
    for (uint32_t i = 0; i < KILN_MAX_WINDS; i++)
        kiln_grid_destroy(&sources->winds[i]);
    for (uint32_t i = 0; i < KILN_MAX_MESHES; i++) {
        kiln_terrain_destroy(&sources->terrains[i]);
        kiln_field_destroy(&sources->fields[i]);
        kiln_depth_maps_destroy(&sources->depths[i]);
    }
}

/* ---- placing --------------------------------------------------------------------------------- */

static struct kiln_grid place_wind(const struct kiln_grid_file *file, size_t first)
{
    const float per_metre[3] = {1.0f / file->spacing[0], 1.0f / file->spacing[1],
                                1.0f / file->spacing[2]};
    return (struct kiln_grid){.origin = canon4(file->origin),
                              .per_metre = canon4(per_metre),
                              .size = {file->size[0], file->size[1], file->size[2], (uint)first}};
}

static struct kiln_grid place_terrain(const struct kiln_terrain *terrain, size_t first)
{
    const float per_metre[3] = {1.0f / terrain->spacing[0], 1.0f, 1.0f / terrain->spacing[1]};
    return (struct kiln_grid){.origin = canon4(terrain->origin),
                              .per_metre = canon4(per_metre),
                              .size = {terrain->samples[0], 1, terrain->samples[1], (uint)first}};
}

static struct kiln_grid place_field(const struct kiln_field *field, size_t first)
{
    const float per_unit = 1.0f / field->spacing;
    const float per_units[3] = {per_unit, per_unit, per_unit};
    return (struct kiln_grid){
        .origin = canon4(field->origin),
        .per_metre = canon4(per_units),
        .size = {field->size[0], field->size[1], field->size[2], (uint)first}};
}

static struct kiln_grid place_depths(const struct kiln_depth_maps *maps, size_t first)
{
    return (struct kiln_grid){
        .low = canon4(maps->min),
        .high = canon4(maps->max),
        .size = {maps->resolution, maps->resolution, maps->count, (uint)first}};
}

static const struct kiln_depth_maps *depths_of(const struct sources *sources, uint32_t wind_count,
                                               uint32_t i)
{
    return i < wind_count ? NULL : sources->depths[i - wind_count];
}

static size_t count_words(const struct kiln_grid *grid, const struct kiln_depth_maps *maps)
{
    return maps ? maps->word_count : (size_t)grid->size.x * grid->size.y * grid->size.z;
}

static float find_steepest(const struct kiln_terrain *terrain)
{
    const size_t count = (size_t)terrain->samples[0] * terrain->samples[1];
    float most = 0.0f;
    for (size_t i = 0; i < count; i++) {
        const struct kiln_terrain_point *p = &terrain->points[i];
        most = exact_max(most, p->slope_x * p->slope_x + p->slope_z * p->slope_z);
    }
    return 1.0001f * exact_sqrt(1.0f + most); /* the factor covers rounding */
}

/* Places the grids in the buffer, one after another. Returns the number of words of all. */
static size_t place(struct kiln_sim_grids *grids, const struct sources *sources)
{
    size_t total = grids->key_words;
    for (uint32_t i = 0; i < grids->count; i++) {
        const uint32_t k = i - grids->wind_count;
        if (i < grids->wind_count) {
            grids->table[i] = place_wind(sources->winds[i], total);
        } else if (sources->terrains[k]) {
            grids->table[i] = place_terrain(sources->terrains[k], total);
            grids->top[i] = sources->terrains[k]->top;
            grids->steepest[i] = find_steepest(sources->terrains[k]);
        } else if (sources->depths[k]) {
            grids->table[i] = place_depths(sources->depths[k], total);
        } else {
            grids->table[i] = place_field(sources->fields[k], total);
        }
        total += count_words(&grids->table[i], depths_of(sources, grids->wind_count, i));
    }
    return total;
}

static void copy_terrain(float4 *words, const struct kiln_terrain *terrain, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const struct kiln_terrain_point *point = &terrain->points[i];
        words[i] = FLOAT4(point->slope_x, point->height, point->slope_z, point->ceiling);
    }
}

static void copy_wind(float4 *words, const struct kiln_grid_file *wind, size_t count)
{
    for (size_t i = 0; i < count; i++)
        words[i] = canon4(wind->samples[i]);
}

static void copy_words(float4 *words, const struct sources *sources, uint32_t wind_count,
                       uint32_t i, size_t count)
{
    const struct kiln_grid_file *wind = i < wind_count ? sources->winds[i] : NULL;
    const struct kiln_terrain *terrain = wind ? NULL : sources->terrains[i - wind_count];
    const struct kiln_field *field = wind ? NULL : sources->fields[i - wind_count];
    const struct kiln_depth_maps *maps = depths_of(sources, wind_count, i);
    if (wind)
        copy_wind(words, wind, count);
    else if (terrain)
        copy_terrain(words, terrain, count);
    else if (field)
        memcpy(words, field->samples, count * sizeof *words);
    else if (maps)
        memcpy(words, maps->words, count * sizeof *words);
}

static bool fill(struct kiln_sim_grids *grids, struct kiln_device *device,
                 const struct kiln_scene *scene, const struct sources *sources,
                 struct kiln_error *error)
{
    const size_t total = place(grids, sources);
    kiln_buffer_init(&grids->words, device, total * sizeof(float4), "grids");
    float4 *words = kiln_buffer_host(&grids->words, KILN_OVERWRITE, error);
    if (!words)
        return false;
    memcpy(words, scene->keys, grids->key_words * sizeof *words);
    words += grids->key_words;
    for (uint32_t i = 0; i < grids->count; i++) {
        const size_t count =
            count_words(&grids->table[i], depths_of(sources, grids->wind_count, i));
        copy_words(words, sources, grids->wind_count, i, count);
        words += count;
    }
    return true;
}

bool kiln_sim_grids_init(struct kiln_sim_grids *grids, struct kiln_device *device,
                         const struct kiln_scene *scene, struct kiln_threads *threads,
                         struct kiln_error *error)
{
    *grids = (struct kiln_sim_grids){
        .key_words = device && kiln_scene_stores_keys(scene) ? scene->key_count : 0};
    kiln_buffer_init(&grids->words, device, 0, "grids");
    list_files(grids, scene);
    struct sources sources = {.winds = {NULL}};
    const bool ok =
        load(grids, scene, &sources, threads, error) &&
        (grids->count + grids->key_words == 0 || fill(grids, device, scene, &sources, error)) &&
        kiln_volumes_init(&grids->volumes, device, scene, error);
    free_sources(&sources);
    return ok;
}

void kiln_sim_grids_finish(struct kiln_sim_grids *grids)
{
    kiln_buffer_finish(&grids->words);
    kiln_volumes_finish(&grids->volumes);
    *grids = (struct kiln_sim_grids){.count = 0};
}
