/* This file makes the volumes of a step: it places the vertices of each mesh on the host, at the
 * start and at the end of the step, has voxels.c put the triangles into a lattice, and stores all
 * lattices in one buffer. */
#include "sim/world/volumes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/skin.h"
#include "base/error.h"
#include "base/matrix.h"
#include "scene/asset_path.h"
#include "shared/exact.h"
#include "sim/world/voxels.h"

struct kiln_volume {
    uint32_t object;
    struct kiln_mesh *mesh;
    const struct kiln_skin *skin;    /* poses the mesh; NULL: it has no animation */
    float (*before)[3], (*after)[3]; /* m: vertices at the start and end of the step */
    float before_s, after_s;         /* the times of both, s */
    bool placed, made;
    bool jumps; /* the clip restarts in this step from a pose unlike its last one */
    struct kiln_voxels voxels;
    bool two_sided;
    size_t first; /* index of the first word of its marks in the buffer; planes follow */
};

bool kiln_volumes_needs(const struct kiln_object *object)
{
    return object->collide && object->kind == KILN_OBJECT_MESH &&
           object->collider == KILN_COLLIDER_VOLUME;
}

/* ---- memory ---------------------------------------------------------------------------------- */

/* Returns whether a vertex at the end of the clip is elsewhere than at the start, by more than a
 * hundredth of the mesh's size. */
static bool jumps(const struct kiln_volume *volume, const struct kiln_object *object)
{
    if (!volume->skin)
        return false;
    const struct kiln_mesh *rest = kiln_skin_mesh(volume->skin);
    float(*vertices)[6] = volume->mesh->vertices;
    const uint32_t clip = object->animation.number, count = rest->vertex_count;
    float most = 0.0f, size = 0.0f;
    kiln_skin_pose(volume->skin, clip, 0.0f, vertices);
    for (uint32_t i = 0; i < count; i++)
        memcpy(volume->before[i], vertices[i], sizeof volume->before[i]);
    kiln_skin_pose(volume->skin, clip, object->animation.length, vertices);
    for (int c = 0; c < 3; c++) {
        size = exact_max(size, rest->max[c] - rest->min[c]);
        for (uint32_t i = 0; i < count; i++)
            most = exact_max(most, exact_abs(vertices[i][c] - volume->before[i][c]));
    }
    return most > 0.01f * size;
}

static struct kiln_volume *load(const struct kiln_scene *scene, uint32_t index,
                                struct kiln_error *error)
{
    const struct kiln_object *object = &scene->backdrop.objects[index];
    struct kiln_volume *volume = calloc(1, sizeof *volume);
    if (!volume) {
        kiln_error_no_memory(error, "the volume");
        return NULL;
    }
    volume->object = index;
    volume->two_sided = object->sides == KILN_SIDES_TWO;
    volume->skin = object->skin;
    volume->mesh = kiln_mesh_copy(object->collision_mesh);
    if (volume->mesh && !volume->two_sided)
        kiln_mesh_face_outwards(volume->mesh);
    const size_t count = object->collision_mesh->vertex_count;
    volume->before = calloc(count, sizeof *volume->before);
    volume->after = calloc(count, sizeof *volume->after);
    if (!volume->mesh || !volume->before || !volume->after) {
        kiln_error_no_memory(error, "%zu vertices of %s", count, object->file);
        kiln_mesh_destroy(&volume->mesh);
        return volume; /* the caller frees it */
    }
    volume->jumps = jumps(volume, object);
    return volume;
}

bool kiln_volumes_init(struct kiln_volumes *volumes, struct kiln_device *device,
                       const struct kiln_scene *scene, struct kiln_error *error)
{
    *volumes = (struct kiln_volumes){.count = 0};
    kiln_buffer_init(&volumes->words, device, 0, "volumes");
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        if (!kiln_volumes_needs(&scene->backdrop.objects[i]))
            continue;
        struct kiln_volume *volume = load(scene, i, error);
        if (!volume)
            return false;
        volumes->of_object[i] = volumes->count;
        volumes->items[volumes->count++] = volume;
        if (!volume->mesh)
            return false;
    }
    return true;
}

/* Adds the memory of one volume. The lattice may stand at any angle to the mesh, so it is taken for
 * a cube around the diagonal of the mesh's box. */
static void add_footprint(const struct kiln_object *object, struct kiln_footprint *footprint)
{
    const struct kiln_volume *v = NULL;
    const struct kiln_mesh *mesh = object->collision_mesh;
    double longest = 0.0, square = 0.0;
    for (int c = 0; c < 3; c++) {
        const double size = (double)mesh->max[c] - (double)mesh->min[c];
        longest = size > longest ? size : longest;
        square += size * size;
    }
    const double around = longest > 0.0 ? sqrt(square) / longest * object->cells + 4.0 : 4.0;
    const double edge = fmin(around, KILN_MAX_VOXEL_EDGE);
    const uint64_t cells = (uint64_t)fmin(edge * edge * edge, KILN_MAX_VOXEL_CELLS);
    const uint64_t planes = (uint64_t)(6.0 * edge * edge);
    const uint64_t words = (cells + 3) / 4 + 3 * planes;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, 1, kiln_mesh_bytes(mesh));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, mesh->vertex_count,
                       sizeof *v->before + sizeof *v->after);
    kiln_voxels_footprint(mesh->vertex_count, mesh->triangle_count, cells, planes, footprint);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, words + words / 2, sizeof(float4));
}

void kiln_volumes_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        if (kiln_volumes_needs(&scene->backdrop.objects[i]))
            add_footprint(&scene->backdrop.objects[i], footprint);
    }
}

void kiln_volumes_finish(struct kiln_volumes *volumes)
{
    for (uint32_t i = 0; i < volumes->count; i++) {
        struct kiln_volume *volume = volumes->items[i];
        kiln_voxels_finish(&volume->voxels);
        kiln_mesh_destroy(&volume->mesh);
        free(volume->before);
        free(volume->after);
        free(volume);
    }
    kiln_buffer_finish(&volumes->words);
    *volumes = (struct kiln_volumes){.count = 0};
}

/* ---- a step ---------------------------------------------------------------------------------- */

/* Computes where the vertices are at a time, in the world. */
static void place_vertices(const struct kiln_scene *scene, const struct kiln_volume *volume,
                           float time_s, float clip_s, float (*to)[3])
{
    const struct kiln_object *object = &scene->backdrop.objects[volume->object];
    const float3 center = kiln_object_center(scene, object, time_s);
    const float scale = kiln_object_length(scene, object, &object->scale, time_s);
    vec3 at = {center.x, center.y, center.z};
    mat3 rotation;
    kiln_object_rotation(scene, object, time_s, rotation);
    if (volume->skin)
        kiln_skin_pose(volume->skin, object->animation.number, clip_s, volume->mesh->vertices);
    for (uint32_t i = 0; i < volume->mesh->vertex_count; i++) {
        glm_mat3_mulv(rotation, volume->mesh->vertices[i], to[i]);
        glm_vec3_scale(to[i], scale, to[i]);
        glm_vec3_add(at, to[i], to[i]);
    }
}

/* Places the vertices of a step. Where a clip's end differs from its start, the mesh does not sweep
 * from one to the other: the step ends with the last pose, and the next begins with another. */
static void place(const struct kiln_scene *scene, struct kiln_volume *volume, float start_s,
                  float end_s)
{
    const struct kiln_animation *clip = &scene->backdrop.objects[volume->object].animation;
    float last_s;
    const bool jumps = volume->jumps && kiln_scene_animation_ends(clip, start_s, end_s, &last_s);
    const float end_clip_s = jumps ? last_s : kiln_scene_animation_s(clip, end_s);
    if (volume->placed && volume->after_s == start_s) {
        float(*swap)[3] = volume->before;
        volume->before = volume->after;
        volume->after = swap;
    } else {
        place_vertices(scene, volume, start_s, kiln_scene_animation_s(clip, start_s),
                       volume->before);
    }
    place_vertices(scene, volume, end_s, end_clip_s, volume->after);
    volume->before_s = start_s;
    volume->after_s = end_s;
    volume->placed = !jumps;
}

/* Returns the edge of a cell, m. For an animated mesh, it follows from the size of the rest
 * pose. */
static float spacing_of(const struct kiln_scene *scene, const struct kiln_volume *volume)
{
    const struct kiln_object *object = &scene->backdrop.objects[volume->object];
    const struct kiln_mesh *mesh = object->collision_mesh;
    float longest = 0.0f;
    for (int c = 0; c < 3; c++)
        longest = exact_max(longest, mesh->max[c] - mesh->min[c]);
    const float scale = kiln_object_length(scene, object, &object->scale, volume->after_s);
    return exact_max(longest * scale / (float)object->cells, 1e-4f);
}

/* Makes the voxels of a mesh. A mesh that has not moved for two steps keeps them. */
static bool make(const struct kiln_scene *scene, struct kiln_volume *volume, bool still,
                 struct kiln_threads *threads, bool *changed, struct kiln_error *error)
{
    const struct kiln_object *object = &scene->backdrop.objects[volume->object];
    const struct kiln_mesh *mesh = volume->mesh;
    const size_t bytes = mesh->vertex_count * sizeof *volume->before;
    if (volume->made && still && object->heading.x.count + object->heading.y.count == 0 &&
        object->heading.z.count == 0 && memcmp(volume->before, volume->after, bytes) == 0)
        return true;
    *changed = true;
    const float3 heading = kiln_scene_value3(scene, &object->heading, volume->before_s);
    const struct kiln_voxels_input input = {
        .before = (const float(*)[3])volume->before,
        .after = (const float(*)[3])volume->after,
        .vertex_count = mesh->vertex_count,
        .triangles = (const uint32_t(*)[3])mesh->triangles,
        .triangle_count = mesh->triangle_count,
        .spacing = spacing_of(scene, volume),
        .heading = float3_normalize(heading, FLOAT3(0.0f, -1.0f, 0.0f)),
        .two_sided = volume->two_sided,
    };
    struct kiln_error why = {0};
    volume->made = kiln_voxels_build(&volume->voxels, &input, threads, &why);
    if (!volume->made)
        kiln_error_set(error, why.code, "backdrop.objects.%u.mesh: '%s': %s", volume->object,
                       kiln_asset_name(scene, object->file), why.message);
    return volume->made;
}

static size_t mark_words(const struct kiln_voxels *v)
{
    return ((size_t)v->size[0] * v->size[1] * v->size[2] + 3) / 4;
}

static void copy_words(float4 *words, const struct kiln_voxels *v)
{
    const size_t cells = (size_t)v->size[0] * v->size[1] * v->size[2];
    words[mark_words(v) - 1] = FLOAT4(0.0f, 0.0f, 0.0f, 0.0f);
    memcpy(words, v->marks, cells * sizeof *v->marks);
    words += mark_words(v);
    for (size_t i = 0; i < v->plane_count; i++) {
        const struct kiln_voxel *p = &v->planes[i];
        words[3 * i] = FLOAT4(p->start.x, p->start.y, p->start.z, p->normal.x);
        words[3 * i + 1] = FLOAT4(p->end.x, p->end.y, p->end.z, p->normal.y);
        words[3 * i + 2] = FLOAT4(p->normal_end.x, p->normal_end.y, p->normal_end.z, p->normal.z);
    }
}

static bool fill(struct kiln_volumes *volumes, struct kiln_error *error)
{
    size_t total = 0;
    for (uint32_t i = 0; i < volumes->count; i++) {
        struct kiln_volume *volume = volumes->items[i];
        volume->first = total;
        total += mark_words(&volume->voxels) + 3 * (size_t)volume->voxels.plane_count;
    }
    const struct kiln_device *device = volumes->words.device;
    const size_t bytes = total * sizeof(float4);
    const uint64_t most = device ? (uint64_t)device->info.max_storage_block_bytes : bytes;
    if (bytes > most) {
        kiln_error_set(error, KILN_DEVICE_FAILED,
                       "backdrop: volumes of meshes take %zu bytes; %s allows %llu; set fewer "
                       "cells, or use simulate=cpu",
                       bytes, device->info.name, (unsigned long long)most);
        return false;
    }
    if (volumes->words.size < total * sizeof(float4))
        kiln_buffer_reserve(&volumes->words, bytes + bytes / 2 <= most ? bytes + bytes / 2 : bytes);
    float4 *words = kiln_buffer_host(&volumes->words, KILN_OVERWRITE, error);
    if (!words)
        return false;
    for (uint32_t i = 0; i < volumes->count; i++)
        copy_words(words + volumes->items[i]->first, &volumes->items[i]->voxels);
    kiln_buffer_set_content(&volumes->words, total * sizeof(float4));
    return true;
}

bool kiln_volumes_step(struct kiln_volumes *volumes, const struct kiln_scene *scene, uint32_t step,
                       struct kiln_threads *threads, struct kiln_error *error)
{
    if (volumes->count == 0 || step == 0)
        return true; /* there is no step 0, which kiln_sim_params_step refuses */
    const float start_s = kiln_scene_time(scene, step - 1), end_s = kiln_scene_time(scene, step);
    bool changed = false;
    for (uint32_t i = 0; i < volumes->count; i++) {
        struct kiln_volume *volume = volumes->items[i];
        const size_t bytes = volume->mesh->vertex_count * sizeof *volume->before;
        const bool still = volume->made && volume->placed && volume->after_s == start_s &&
                           memcmp(volume->before, volume->after, bytes) == 0;
        place(scene, volume, start_s, end_s);
        if (!make(scene, volume, still, threads, &changed, error))
            return false;
    }
    return !changed || fill(volumes, error);
}

/* ---- colliders and table of grids ------------------------------------------------------------ */

/* Finds the bounding box of the vertices at a time, a cell larger on each side. */
static void bound(const struct kiln_volume *volume, float (*vertices)[3], float4 *min, float4 *max)
{
    float low[3], high[3];
    for (int c = 0; c < 3; c++) {
        low[c] = high[c] = vertices[0][c];
        for (uint32_t i = 1; i < volume->mesh->vertex_count; i++) {
            low[c] = exact_min(low[c], vertices[i][c]);
            high[c] = exact_max(high[c], vertices[i][c]);
        }
        low[c] = exact_canon(low[c] - volume->voxels.spacing);
        high[c] = exact_canon(high[c] + volume->voxels.spacing);
    }
    *min = FLOAT4(low[0], low[1], low[2], 0.0f);
    *max = FLOAT4(high[0], high[1], high[2], 0.0f);
}

struct kiln_collider kiln_volumes_collider(const struct kiln_volumes *volumes, uint32_t object,
                                           uint32_t first, struct kiln_grid table[KILN_MAX_GRIDS])
{
    const uint32_t number = volumes->of_object[object];
    const struct kiln_volume *volume = volumes->items[number];
    const struct kiln_voxels *v = &volume->voxels;
    const uint32_t place = first + number;
    table[place] = (struct kiln_grid){
        .origin = FLOAT4(v->origin[0], v->origin[1], v->origin[2], 0.0f),
        .per_metre = FLOAT4(v->per_metre, v->per_metre, v->per_metre, 0.0f),
        .size = {v->size[0], v->size[1], v->size[2], (uint)volume->first},
    };
    struct kiln_collider c = {
        .grid = place,
        .planes =
            (uint)(volume->first + mark_words(v)) | (volume->two_sided ? VOLUME_TWO_SIDED : 0),
    };
    bound(volume, volume->before, &c.min, &c.max);
    bound(volume, volume->after, &c.min_end, &c.max_end);
    return c;
}

uint32_t kiln_volumes_planes(const struct kiln_volumes *volumes, uint32_t *cells)
{
    uint32_t planes = 0;
    *cells = 0;
    for (uint32_t i = 0; i < volumes->count; i++) {
        const struct kiln_voxels *v = &volumes->items[i]->voxels;
        planes += v->plane_count;
        *cells += v->size[0] * v->size[1] * v->size[2];
    }
    return planes;
}
