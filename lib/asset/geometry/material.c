/* This file checks and copies the materials that kiln-decode sends, which may have been taken over
 * by the file that it reads: numbers are finite and within their ranges, texts end, paths lead
 * nowhere else, and parts of the bytes are within them. */
#include "asset/geometry/material.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/mesh_in.h"
#include "base/error.h"
#include "shared/exact.h"

struct kiln_material kiln_material_default(void)
{
    struct kiln_material material = {
        .color = {1, 1, 1}, .alpha = 1, .roughness = 1, .cutoff = 0.5f};
    for (int i = 0; i < KILN_MATERIAL_USES; i++)
        material.maps[i] = (struct kiln_material_map){
            .texture = KILN_NO_TEXTURE, .strength = 1, .rows = {{1, 0, 0}, {0, 1, 0}}};
    return material;
}

float kiln_light_of_srgb(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : exact_pow((encoded + 0.055f) / 1.055f, 2.4f);
}

void kiln_mesh_looks_destroy(struct kiln_mesh_looks **looks)
{
    if (!*looks)
        return;
    free((*looks)->materials);
    free((*looks)->textures);
    free((*looks)->bytes);
    free((*looks)->of_triangles);
    free((*looks)->colors);
    free((*looks)->second_uvs);
    free(*looks);
    *looks = NULL;
}

bool kiln_path_stays_below(const char *path)
{
    if (path[0] == '/' || strchr(path, ':') || strchr(path, '\\'))
        return false;
    for (const char *part = path; *part;) {
        size_t length = strcspn(part, "/");
        if (length == 2 && part[0] == '.' && part[1] == '.')
            return false;
        part += length + (part[length] == '/');
    }
    return true;
}

/* ---- checks ---------------------------------------------------------------------------------- */

static bool are_within(const float *numbers, size_t count, float least, float most)
{
    for (size_t i = 0; i < count; i++) {
        if (!(numbers[i] >= least && numbers[i] <= most))
            return false;
    }
    return true;
}

static bool is_map_sound(const struct kiln_material_map *map, uint32_t texture_count)
{
    const float far = KILN_MAX_MATERIAL_NUMBER;
    return (map->texture == KILN_NO_TEXTURE || map->texture < texture_count) &&
           map->uv_set < KILN_UV_SETS && map->channel < KILN_TEXTURE_CHANNELS &&
           map->wrap[0] < KILN_TEXTURE_WRAPS && map->wrap[1] < KILN_TEXTURE_WRAPS &&
           map->is_nearest <= 1 && map->is_inverse <= 1 &&
           are_within(&map->strength, 1, -far, far) && are_within(map->rows[0], 3, -far, far) &&
           are_within(map->rows[1], 3, -far, far);
}

static bool is_material_sound(const struct kiln_material *material, uint32_t texture_count)
{
    bool good = memchr(material->name, '\0', sizeof material->name) &&
                are_within(material->color, 3, 0, 1) && are_within(&material->alpha, 1, 0, 1) &&
                are_within(&material->roughness, 1, 0, 1) &&
                are_within(&material->metalness, 1, 0, 1) &&
                are_within(material->emission, 3, 0, KILN_MAX_EMISSION) &&
                are_within(&material->cutoff, 1, 0, KILN_MAX_MATERIAL_NUMBER) &&
                material->alpha_mode <= KILN_ALPHA_BLEND && material->is_two_sided <= 1 &&
                material->is_unlit <= 1;
    for (int i = 0; good && i < KILN_MATERIAL_USES; i++)
        good = is_map_sound(&material->maps[i], texture_count);
    return good;
}

static bool is_texture_sound(const struct kiln_texture *texture, uint32_t byte_count)
{
    if (!memchr(texture->file, '\0', sizeof texture->file) || texture->is_missing > 1)
        return false;
    if (*texture->file)
        return texture->byte_count == 0 && kiln_path_stays_below(texture->file);
    return texture->byte_count > 0 && texture->first_byte <= byte_count &&
           texture->byte_count <= byte_count - texture->first_byte;
}

static bool are_triangles_sound(const struct kiln_mesh_result *result)
{
    const struct kiln_looks_result *looks = &result->looks;
    for (uint32_t i = 0; i < result->triangle_count; i++) {
        if (looks->of_triangles[i] != KILN_NO_MATERIAL &&
            looks->of_triangles[i] >= looks->material_count)
            return false;
    }
    return true;
}

static bool are_vertices_sound(const struct kiln_mesh_result *result)
{
    const struct kiln_looks_result *looks = &result->looks;
    const size_t count = result->vertex_count;
    for (size_t i = 0; looks->has_uvs && i < 2 * count; i++) {
        if (!isfinite(result->uvs[i / 2][i % 2]))
            return false;
    }
    for (size_t i = 0; looks->has_second_uvs && i < 2 * count; i++) {
        if (!isfinite(looks->second_uvs[i / 2][i % 2]))
            return false;
    }
    return !looks->has_colors || are_within(looks->colors[0], 4 * count, 0, 1);
}

static bool is_sound(const struct kiln_mesh_result *result)
{
    const struct kiln_looks_result *looks = &result->looks;
    bool good = are_triangles_sound(result) && are_vertices_sound(result);
    for (uint32_t i = 0; good && i < looks->material_count; i++)
        good = is_material_sound(&looks->materials[i], looks->texture_count);
    for (uint32_t i = 0; good && i < looks->texture_count; i++)
        good = is_texture_sound(&looks->textures[i], looks->byte_count);
    return good;
}

/* ---- copying --------------------------------------------------------------------------------- */

/* Copies an array; one without entries gets memory, too, so that NULL is a failure. */
static void *copy_of(const void *from, size_t count, size_t size)
{
    void *copy = calloc(count + 1, size);
    if (copy && count > 0)
        memcpy(copy, from, count * size);
    return copy;
}

static struct kiln_mesh_looks *copy(const struct kiln_mesh_result *result)
{
    const struct kiln_looks_result *from = &result->looks;
    const size_t vertices = result->vertex_count;
    struct kiln_mesh_looks *looks = calloc(1, sizeof *looks);
    if (!looks)
        return NULL;
    looks->material_count = from->material_count;
    looks->texture_count = from->texture_count;
    looks->byte_count = from->byte_count;
    looks->materials = copy_of(from->materials, from->material_count, sizeof *from->materials);
    looks->textures = copy_of(from->textures, from->texture_count, sizeof *from->textures);
    looks->bytes = copy_of(from->bytes, from->byte_count, 1);
    looks->of_triangles =
        copy_of(from->of_triangles, result->triangle_count, sizeof *from->of_triangles);
    if (from->has_colors)
        looks->colors = copy_of(from->colors, vertices, sizeof *from->colors);
    if (from->has_second_uvs)
        looks->second_uvs = copy_of(from->second_uvs, vertices, sizeof *from->second_uvs);
    if (!looks->materials || !looks->textures || !looks->bytes || !looks->of_triangles ||
        (from->has_colors && !looks->colors) || (from->has_second_uvs && !looks->second_uvs))
        kiln_mesh_looks_destroy(&looks);
    return looks;
}

struct kiln_mesh_looks *kiln_looks_take(const char *name, const struct kiln_mesh_result *result,
                                        struct kiln_error *error)
{
    if (!is_sound(result)) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the mesh is broken: the importer returned inconsistent materials",
                       name);
        return NULL;
    }
    struct kiln_mesh_looks *looks = copy(result);
    if (!looks)
        kiln_error_no_memory(error, "reading the materials of %s", name);
    return looks;
}
