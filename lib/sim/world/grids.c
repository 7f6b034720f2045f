/* This file loads or makes the grids of a scene (wind, terrain, and those of meshes), and puts them
 * all into one buffer, on the host or in GL. Those of baked winds are written by sim/step/bakes.c.
 */
#include "sim/world/grids.h"

#include <string.h>

#include "asset/geometry/grid_in.h"
#include "asset/geometry/nearest.h"
#include "base/error.h"
#include "scene/baked.h"
#include "scene/source.h"
#include "shared/exact.h"
#include "sim/world/papers/papers.h"
#include "sim/world/posed_births.h"

/* The grids of meshes by how particles collide with them. */
static const struct kiln_mesh_row *const MESH_ROWS[KILN_COLLIDER_KINDS] = {
    [KILN_COLLIDER_FIELD] = &kiln_mesh_field_row,
    [KILN_COLLIDER_DEPTH_MAPS] = &kiln_mesh_depth_maps_row,
};

/* The sources of the grids in their order: winds, then objects. An object is a terrain or a mesh.
 */
struct sources {
    struct kiln_grid_file *winds[KILN_MAX_WINDS];
    struct kiln_terrain *terrains[KILN_MAX_MESHES];
    const struct kiln_mesh_row *rows[KILN_MAX_MESHES];
    void *meshes[KILN_MAX_MESHES]; /* what the rows created */
};

const struct kiln_mesh_row *kiln_sim_mesh_row(const struct kiln_object *mesh)
{
    return MESH_ROWS[mesh->collider];
}

uint32_t kiln_sim_grids_find(const struct kiln_sim_grids *grids, const char *file)
{
    uint32_t i = 0;
    while (i < grids->file_count && strcmp(grids->files[i], file) != 0)
        i++;
    return i;
}

uint32_t kiln_sim_grids_find_baked(const struct kiln_sim_grids *grids,
                                   const struct kiln_force *baked)
{
    uint32_t i = grids->file_count;
    while (i < grids->wind_count && grids->baked[i - grids->file_count] != baked)
        i++;
    return i;
}

bool kiln_sim_grids_needs(const struct kiln_object *object)
{
    return object->collide && kiln_object_is_mesh(object) && !kiln_volumes_needs(object);
}

/* Lists the winds that have grids: files, each once, and then baked ones. */
static void list_winds(struct kiln_sim_grids *grids, const struct kiln_scene *scene)
{
    const struct kiln_force *force;
    for (uint32_t i = 0; i < kiln_force_owners(scene); i++) {
        for (uint32_t k = 0; (force = kiln_owner_force(scene, i, k)) != NULL; k++) {
            if (force->kind == KILN_FORCE_FIELD &&
                kiln_sim_grids_find(grids, force->file) == grids->file_count)
                grids->files[grids->file_count++] = force->file;
        }
    }
    grids->wind_count = grids->file_count;
    for (uint32_t i = 0; i < kiln_force_owners(scene); i++) {
        for (uint32_t k = 0; (force = kiln_owner_force(scene, i, k)) != NULL; k++) {
            if (kiln_force_is_baked(force))
                grids->baked[grids->wind_count++ - grids->file_count] = force;
        }
    }
    grids->count = grids->wind_count;
}

static float4 canon4(const float v[3])
{
    return FLOAT4(exact_canon(v[0]), exact_canon(v[1]), exact_canon(v[2]), 0.0f);
}

/* ---- loading --------------------------------------------------------------------------------- */

static bool load_object(struct sources *sources, uint32_t number, const struct kiln_scene *scene,
                        const struct kiln_object *object, struct kiln_threads *threads,
                        struct kiln_error *error)
{
    if (object->kind == KILN_OBJECT_MESH) {
        const struct kiln_mesh_row *row = kiln_sim_mesh_row(object);
        sources->rows[number] = row;
        sources->meshes[number] = row->create(scene, object, threads, error);
        return sources->meshes[number] != NULL;
    }
    const struct kiln_terrain_params params = kiln_scene_terrain(scene, object);
    sources->terrains[number] = kiln_terrain_create(&params, error);
    return sources->terrains[number] != NULL;
}

static bool load(struct kiln_sim_grids *grids, const struct kiln_scene *scene,
                 struct sources *sources, struct kiln_threads *threads, struct kiln_error *error)
{
    for (uint32_t i = 0; i < grids->file_count; i++) {
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
        if (sources->meshes[i])
            sources->rows[i]->destroy(sources->meshes[i]);
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

static struct kiln_grid place_baked(const struct kiln_force *baked, size_t first)
{
    const float center[3] = {baked->box_center.x.constant, baked->box_center.y.constant,
                             baked->box_center.z.constant};
    const float edges[3] = {baked->box_size.x.constant, baked->box_size.y.constant,
                            baked->box_size.z.constant};
    float origin[3], per_metre[3], spacing[3];
    uint32_t size[3];
    kiln_baked_samples(baked, size);
    for (int c = 0; c < 3; c++) {
        const float cells = (float)(size[c] - 1);
        origin[c] = center[c] - 0.5f * edges[c];
        per_metre[c] = cells / edges[c];
        spacing[c] = edges[c] / cells;
    }
    return (struct kiln_grid){.origin = canon4(origin),
                              .per_metre = canon4(per_metre),
                              .high = canon4(spacing),
                              .size = {size[0], size[1], size[2], (uint)first}};
}

static struct kiln_grid place_terrain(const struct kiln_terrain *terrain, size_t first)
{
    const float per_metre[3] = {1.0f / terrain->spacing[0], 1.0f, 1.0f / terrain->spacing[1]};
    return (struct kiln_grid){.origin = canon4(terrain->origin),
                              .per_metre = canon4(per_metre),
                              .size = {terrain->samples[0], 1, terrain->samples[1], (uint)first}};
}

/* Returns the number of words of a placed grid. */
static size_t count_words(const struct kiln_sim_grids *grids, const struct sources *sources,
                          uint32_t i)
{
    const struct kiln_grid *grid = &grids->table[i];
    const uint32_t k = i - grids->wind_count;
    if (i < grids->wind_count || sources->terrains[k])
        return (size_t)grid->size.x * grid->size.y * grid->size.z;
    size_t count;
    sources->rows[k]->words(sources->meshes[k], &count);
    return count;
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
        if (i < grids->file_count) {
            grids->table[i] = place_wind(sources->winds[i], total);
        } else if (i < grids->wind_count) {
            grids->table[i] = place_baked(grids->baked[i - grids->file_count], total);
        } else if (sources->terrains[k]) {
            grids->table[i] = place_terrain(sources->terrains[k], total);
            grids->top[i] = sources->terrains[k]->top;
            grids->steepest[i] = find_steepest(sources->terrains[k]);
        } else {
            grids->table[i] = sources->rows[k]->place(sources->meshes[k], total);
        }
        total += count_words(grids, sources, i);
    }
    return total;
}

/* Places what particles are born on, behind the grids. Returns the number of words of all. */
static size_t place_births(struct kiln_sim_grids *grids, const struct kiln_scene *scene,
                           size_t total)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_source *source = scene->systems[i].emit.source.made;
        grids->sources[i] = (uint32_t)total;
        total += source ? source->word_count : 0;
    }
    return total;
}

static void copy_births(float4 *words, const struct kiln_scene *scene)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_source *source = scene->systems[i].emit.source.made;
        if (!source)
            continue;
        memcpy(words, source->words, source->word_count * sizeof *words);
        words += source->word_count;
    }
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

static void copy_mesh(float4 *words, const struct sources *sources, uint32_t k)
{
    size_t count;
    const float(*from)[4] = sources->rows[k]->words(sources->meshes[k], &count);
    memcpy(words, from, count * sizeof *words);
}

/* Copies the words of grid i. Those of baked winds are written before the first step that reads
 * them. */
static void copy_words(float4 *words, const struct kiln_sim_grids *grids,
                       const struct sources *sources, uint32_t i, size_t count)
{
    const uint32_t k = i - grids->wind_count;
    if (i < grids->file_count)
        copy_wind(words, sources->winds[i], count);
    else if (i < grids->wind_count)
        memset(words, 0, count * sizeof *words);
    else if (sources->terrains[k])
        copy_terrain(words, sources->terrains[k], count);
    else
        copy_mesh(words, sources, k);
}

static bool fill(struct kiln_sim_grids *grids, struct kiln_device *device,
                 const struct kiln_scene *scene, const struct sources *sources,
                 struct kiln_error *error)
{
    const size_t total = place_births(grids, scene, place(grids, sources));
    const size_t bytes = total * sizeof(float4);
    if (device && bytes > (uint64_t)device->info.max_storage_block_bytes)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "grids, and what particles are born on, take %zu bytes; %s allows "
                              "%llu; use simulate=cpu",
                              bytes, device->info.name,
                              (unsigned long long)device->info.max_storage_block_bytes);
    kiln_buffer_init(&grids->words, device, bytes, "grids");
    float4 *words = kiln_buffer_host(&grids->words, KILN_OVERWRITE, error);
    if (!words)
        return false;
    memcpy(words, scene->keys, grids->key_words * sizeof *words);
    words += grids->key_words;
    for (uint32_t i = 0; i < grids->count; i++) {
        const size_t count = count_words(grids, sources, i);
        copy_words(words, grids, sources, i, count);
        words += count;
    }
    copy_births(words, scene);
    return true;
}

bool kiln_sim_grids_init(struct kiln_sim_grids *grids, struct kiln_device *device,
                         const struct kiln_scene *scene, struct kiln_threads *threads,
                         struct kiln_error *error)
{
    *grids = (struct kiln_sim_grids){
        .key_words = device && kiln_scene_stores_keys(scene) ? scene->key_count : 0,
        .has_sources = kiln_sources_sizes(scene).words > 0};
    kiln_buffer_init(&grids->words, device, 0, "grids");
    list_winds(grids, scene);
    struct sources sources = {.winds = {NULL}};
    const bool ok = load(grids, scene, &sources, threads, error) &&
                    (grids->count + grids->key_words + grids->has_sources == 0 ||
                     fill(grids, device, scene, &sources, error)) &&
                    kiln_sim_posed_init(grids, scene, error) &&
                    kiln_volumes_init(&grids->volumes, device, scene, error);
    free_sources(&sources);
    return ok;
}

void kiln_sim_grids_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    /* Grids that are loaded take about as much as their words once more, until all of them are
     * copied. Baked winds are not loaded. */
    uint64_t making = 0, loaded = scene->samples;
    const struct kiln_force *force;
    for (uint32_t i = 0; i < kiln_force_owners(scene); i++) {
        for (uint32_t k = 0; (force = kiln_owner_force(scene, i, k)) != NULL; k++) {
            uint32_t size[3];
            loaded -= kiln_force_is_baked(force) ? kiln_baked_samples(force, size) : 0;
        }
    }
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (!kiln_sim_grids_needs(object) || object->kind != KILN_OBJECT_MESH)
            continue;
        const uint64_t bytes = kiln_nearest_bytes(object->collision_mesh);
        making = bytes > making ? bytes : making;
    }
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, scene->samples, sizeof(float4));
    kiln_footprint_pass(footprint, KILN_FOOTPRINT_OBJECTS,
                        loaded * sizeof(struct kiln_terrain_point) + making);
    /* The scene has the words of sources, too. */
    const struct kiln_sources_sizes sizes = kiln_sources_sizes(scene);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, sizes.words, 2 * sizeof(float4));
    kiln_footprint_pass(footprint, KILN_FOOTPRINT_OBJECTS, sizes.making);
    kiln_sim_posed_footprint(scene, footprint);
    kiln_volumes_footprint(scene, footprint);
}

void kiln_sim_grids_finish(struct kiln_sim_grids *grids)
{
    kiln_sim_posed_finish(grids);
    kiln_buffer_finish(&grids->words);
    kiln_volumes_finish(&grids->volumes);
    *grids = (struct kiln_sim_grids){.count = 0};
}
