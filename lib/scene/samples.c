/* This file counts the samples of the grids of a scene: wind files, baked winds, terrain, distance
 * fields and depth maps. kiln_validate calls it while a scene is loaded, so that a scene with too
 * many samples is refused before its grids are made. scene/work.c computes the memory for them from
 * the sum.
 *
 * Wind files are read, since only the files know their sizes. The other sizes follow from the
 * options and the meshes. sim/world/grids.c makes the grids later, and must find the sizes that are
 * counted here; it takes the reach of a distance field from this file for that reason. */
#include "scene/samples.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "asset/geometry/closed.h"
#include "asset/geometry/field.h"
#include "asset/geometry/grid_in.h"
#include "base/error.h"
#include "scene/asset_path.h"
#include "scene/baked.h"
#include "scene/papers/papers.h"

/* Holds the sum while grids are counted. An error points at the key of the largest grid, which is
 * the one to make smaller. */
struct count {
    uint64_t samples, largest;
    char path[160]; /* path of the largest grid's key */
};

static void add(struct count *count, uint64_t samples, const char *path)
{
    count->samples += samples;
    if (samples <= count->largest)
        return;
    count->largest = samples;
    snprintf(count->path, sizeof count->path, "%s", path);
}

/* ---- wind ------------------------------------------------------------------------------------ */

/* Lists the wind files that have been counted. A file that several forces name is one grid. */
struct winds {
    const char *files[KILN_MAX_WINDS];
    uint32_t count;
};

static bool is_known(const struct winds *winds, const char *file)
{
    for (uint32_t i = 0; i < winds->count; i++) {
        if (strcmp(winds->files[i], file) == 0)
            return true;
    }
    return false;
}

static bool count_wind(struct kiln_reader *reader, const struct kiln_node *root, const char *path,
                       const char *file, struct count *count)
{
    struct kiln_error error = {0};
    struct kiln_grid_file *grid = kiln_grid_load(kiln_reader_scene(reader)->loader, file, &error);
    if (!grid)
        return kiln_asset_fail(reader, root, path, file, &error);
    add(count, (uint64_t)grid->size[0] * grid->size[1] * grid->size[2], path);
    kiln_grid_destroy(&grid);
    return true;
}

static bool count_winds(struct kiln_reader *reader, const struct kiln_node *root, uint32_t owner,
                        struct winds *winds, struct count *count)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_force *force;
    for (uint32_t i = 0; (force = kiln_owner_force(scene, owner, i)) != NULL; i++) {
        char path[128], key[160];
        if (force->kind != KILN_FORCE_FIELD || is_known(winds, force->file))
            continue;
        kiln_owner_force_path(scene, owner, i, path, sizeof path);
        snprintf(key, sizeof key, "%s.file", path);
        if (winds->count == KILN_MAX_WINDS)
            return kiln_reader_error_at(reader, root, key,
                                        "more than %d files of wind; no more are allowed",
                                        KILN_MAX_WINDS);
        winds->files[winds->count++] = force->file;
        if (!count_wind(reader, root, key, force->file, count))
            return false;
    }
    return true;
}

/* Counts the samples of the baked winds of a system or of a domain of gas. */
static bool count_baked(struct kiln_reader *reader, const struct kiln_node *root, uint32_t owner,
                        uint32_t *baked, struct count *count)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_force *force;
    for (uint32_t i = 0; (force = kiln_owner_force(scene, owner, i)) != NULL; i++) {
        uint32_t size[3];
        char wind[128], path[160];
        if (!kiln_force_is_baked(force))
            continue;
        kiln_owner_force_path(scene, owner, i, wind, sizeof wind);
        snprintf(path, sizeof path, "%s.cells", wind);
        if (++*baked > KILN_MAX_BAKED)
            return kiln_reader_error_at(reader, root, path,
                                        "more than %d baked winds; no more are allowed",
                                        KILN_MAX_BAKED);
        add(count, kiln_baked_samples(force, size), path);
    }
    return true;
}

/* ---- grids that particles collide with ---------------------------------------------------- */

float kiln_scene_field_reach(const struct kiln_scene *scene, const struct kiln_object *mesh)
{
    float largest = 0.0f;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const float radius = kiln_scene_contact_radius(scene, i);
        if (scene->systems[i].collide.enabled && radius > largest)
            largest = radius;
    }
    const float smallest = kiln_scene_value_min(scene, &mesh->scale);
    return largest > 0.0f ? largest / (smallest > 1e-6f ? smallest : 1e-6f) : 0.0f;
}

/* Counts the samples of a distance field. Where the mesh is not closed, the error names the
 * colliders that take such a mesh. */
static bool count_field(const struct kiln_scene *scene, const struct kiln_object *mesh,
                        size_t *samples, struct kiln_error *error)
{
    struct kiln_error reason = {0};
    if (kiln_field_check(mesh->collision_mesh, mesh->file, mesh->cells,
                         kiln_scene_field_reach(scene, mesh), samples, error))
        return true;
    if (error->code == KILN_INVALID_INPUT &&
        !kiln_mesh_check_closed(mesh->collision_mesh, mesh->file, &reason) &&
        reason.code == KILN_INVALID_INPUT)
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%.800s; 'collider: volume' and 'collider: depth_maps' take meshes that are "
                       "not closed",
                       reason.message);
    return false;
}

static const struct kiln_mesh_grid FIELD = {.count = count_field};

static const struct kiln_mesh_grid *const MESH_GRIDS[KILN_COLLIDER_KINDS] = {
    [KILN_COLLIDER_FIELD] = &FIELD,
    [KILN_COLLIDER_DEPTH_MAPS] = &kiln_mesh_grid_depth_maps,
};

const struct kiln_mesh_grid *kiln_mesh_grid_of(enum kiln_collider_kind collider)
{
    return MESH_GRIDS[collider];
}

/* Counts the grid of an object. A mesh of collider `volume` has none: its cells are made anew in
 * each step. */
static bool count_object(struct kiln_reader *reader, const struct kiln_node *root, uint32_t index,
                         struct count *count)
{
    const struct kiln_object *object = &kiln_reader_scene(reader)->backdrop.objects[index];
    char path[64];
    if (!object->collide || !kiln_object_is_mesh(object))
        return true;
    if (object->kind == KILN_OBJECT_TERRAIN) {
        snprintf(path, sizeof path, "backdrop.objects.%u.terrain.samples", index);
        add(count, (uint64_t)object->samples[0] * object->samples[1], path);
        return true;
    }
    const struct kiln_mesh_grid *grid = kiln_mesh_grid_of(object->collider);
    struct kiln_error error = {0};
    size_t samples = 0;
    if (!grid)
        return true;
    snprintf(path, sizeof path, "backdrop.objects.%u.mesh.collide", index);
    if (!grid->count(kiln_reader_scene(reader), object, &samples, &error))
        return kiln_asset_fail(reader, root, path, object->file, &error);
    add(count, samples, path);
    return true;
}

/* ---- all grids ------------------------------------------------------------------------------- */

bool kiln_samples_settle(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    struct count count = {.samples = 0};
    struct winds winds = {.count = 0};
    uint32_t baked = 0;
    for (uint32_t i = 0; i < kiln_force_owners(scene); i++) {
        if (!count_winds(reader, root, i, &winds, &count) ||
            !count_baked(reader, root, i, &baked, &count))
            return false;
    }
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        if (!count_object(reader, root, i, &count))
            return false;
    }
    scene->samples = count.samples;
    return count.samples <= KILN_MAX_GRID_SAMPLES ||
           kiln_reader_error_at(reader, root, count.path,
                                "wind, terrain and meshes that move particles have %" PRIu64
                                " samples altogether; a scene has at most %d",
                                count.samples, KILN_MAX_GRID_SAMPLES);
}
