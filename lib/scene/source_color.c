/* This file samples the colours of the cells of sources, when a scene is read. A triangle gets a
 * triangle of colours of its own, about four for each texel that it shows, so that drawing
 * needs neither texture coordinates nor textures (Yuksel, Keyser and House 2010, "Mesh colors").
 * Drawing finds a particle's cell and place again from its random numbers. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/material.h"
#include "asset/image/image.h"
#include "asset/image/linear.h"
#include "base/budget.h"
#include "base/error.h"
#include "scene/asset_path.h"
#include "scene/source_mesh.h"
#include "shared/exact.h"
#include "shared/source.h"

enum {
    MOST_ROWS = 512,       /* of the colours of a triangle */
    VERTEX_ROWS = 8,       /* where only the colours of the corners differ */
    MOST_COLORS = 1 << 20, /* of a source, unless each cell has one only */
};

uint32_t kiln_source_pack(const float rgb[3])
{
    uint32_t color = 0;
    for (uint32_t c = 0; c < 3; c++) {
        const float x = rgb[c] > 0.0f ? fminf(rgb[c], 1.0f) : 0.0f; /* a NaN becomes 0 */
        color |= (uint32_t)(sqrtf(x) * 1023.0f + 0.5f) << (10 * c);
    }
    return color;
}

/* ---- colours of a mesh ----------------------------------------------------------------------- */

struct painter {
    const struct kiln_mesh *mesh;
    const struct kiln_mesh_looks *looks;
    const float *plain; /* the colour of what has neither a material nor colours of vertices */
    struct kiln_asset_image **textures; /* one for each of the looks; NULL: it is not shown */
    uint32_t *rows;                     /* of colours, of each triangle */
};

static const struct kiln_material *material_of(const struct painter *p, uint32_t triangle)
{
    const uint16_t number = p->looks->of_triangles[triangle];
    return number == KILN_NO_MATERIAL ? NULL : &p->looks->materials[number];
}

/* Returns the texture of a material's colour, or NULL. */
static const struct kiln_asset_image *texture_of(const struct painter *p,
                                                 const struct kiln_material *material)
{
    const uint32_t number = material ? material->maps[KILN_USE_COLOR].texture : KILN_NO_TEXTURE;
    const bool has_uvs =
        material && (material->maps[KILN_USE_COLOR].uv_set == 0 ? p->mesh->uvs != NULL
                                                                : p->looks->second_uvs != NULL);
    return number == KILN_NO_TEXTURE || !has_uvs ? NULL : p->textures[number];
}

static float wrapped(float x, uint32_t wrap)
{
    if (wrap == KILN_WRAP_CLAMP)
        return exact_clamp(x, 0.0f, 1.0f);
    const float turns = floorf(x), rest = x - turns;
    const bool mirrored = wrap == KILN_WRAP_MIRROR && turns - 2.0f * floorf(turns * 0.5f) != 0.0f;
    return mirrored ? 1.0f - rest : rest;
}

/* Returns where a vertex lies on a material's texture of colours. */
static void uv_of(const struct painter *p, const struct kiln_material *material, uint32_t vertex,
                  float uv[2])
{
    const struct kiln_material_map *map = &material->maps[KILN_USE_COLOR];
    const float *from = map->uv_set == 0 ? p->mesh->uvs[vertex] : p->looks->second_uvs[vertex];
    for (int c = 0; c < 2; c++)
        uv[c] = map->rows[c][0] * from[0] + map->rows[c][1] * from[1] + map->rows[c][2];
}

static float number_at(const struct kiln_asset_image *image, size_t at)
{
    if (image->type == KILN_IMAGE_F32)
        return ((const float *)image->pixels)[at];
    if (image->type == KILN_IMAGE_U16)
        return (float)((const uint16_t *)image->pixels)[at] / 65535.0f;
    return (float)((const uint8_t *)image->pixels)[at] / 255.0f;
}

void kiln_source_pixel(const struct kiln_asset_image *image, uint32_t x, uint32_t y, float rgb[3])
{
    const size_t at = ((size_t)y * image->width + x) * 4;
    const float alpha = number_at(image, at + 3);
    const float factor = image->premultiplied ? alpha : 1.0f;
    for (size_t c = 0; c < 3; c++) {
        const float light = kiln_light_of(image, number_at(image, at + c), factor);
        rgb[c] = factor > 0.0f ? light / factor : light;
    }
}

static uint32_t pixel_of(float part, uint32_t edge)
{
    const float place = part * (float)edge;
    const uint32_t pixel = place > 0.0f ? (uint32_t)fminf(place, (float)(edge - 1)) : 0;
    return pixel < edge ? pixel : edge - 1;
}

/* Multiplies a colour by that of the vertices and the texture at a place of a triangle. */
static uint32_t color_at(const struct painter *p, const struct kiln_material *material,
                         const uint32_t corners[3], float s, float t)
{
    const float weights[3] = {1.0f - s - t, s, t};
    const struct kiln_asset_image *texture = texture_of(p, material);
    float rgb[3] = {1.0f, 1.0f, 1.0f};
    if (material)
        memcpy(rgb, material->color, sizeof rgb);
    else if (!p->looks->colors)
        memcpy(rgb, p->plain, sizeof rgb);
    if (p->looks->colors) {
        for (int c = 0; c < 3; c++) {
            float mean = 0.0f;
            for (int k = 0; k < 3; k++)
                mean += weights[k] * p->looks->colors[corners[k]][c];
            rgb[c] *= mean;
        }
    }
    if (texture) {
        const struct kiln_material_map *map = &material->maps[KILN_USE_COLOR];
        float at[2] = {0}, shown[3];
        for (int k = 0; k < 3; k++) {
            float uv[2];
            uv_of(p, material, corners[k], uv);
            at[0] += weights[k] * uv[0];
            at[1] += weights[k] * uv[1];
        }
        const uint32_t x = pixel_of(wrapped(at[0], map->wrap[0]), texture->width);
        const uint32_t y = pixel_of(1.0f - wrapped(at[1], map->wrap[1]), texture->height);
        kiln_source_pixel(texture, x, y, shown);
        for (int c = 0; c < 3; c++)
            rgb[c] *= shown[c];
    }
    return kiln_source_pack(rgb);
}

/* Returns how many rows of colours a triangle needs for the texels that it shows. */
static uint32_t rows_of(const struct painter *p, uint32_t triangle)
{
    const struct kiln_material *material = material_of(p, triangle);
    const struct kiln_asset_image *texture = texture_of(p, material);
    if (!texture)
        return p->looks->colors ? VERTEX_ROWS : 1;
    float uv[3][2];
    for (int k = 0; k < 3; k++)
        uv_of(p, material, p->mesh->triangles[triangle][k], uv[k]);
    const float across = (uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) -
                         (uv[1][1] - uv[0][1]) * (uv[2][0] - uv[0][0]);
    const float texels = fabsf(across) * (float)texture->width * (float)texture->height;
    const float rows = ceilf(2.0f * sqrtf(texels));
    return rows > 1.0f ? (uint32_t)fminf(rows, (float)MOST_ROWS) : 1;
}

static uint64_t colors_of(uint64_t rows)
{
    return rows * (rows + 1) / 2;
}

/* Chooses the rows of all triangles so that a source does not have too many colours. */
static uint64_t choose_rows(struct painter *p)
{
    const uint32_t count = p->mesh->triangle_count;
    for (uint32_t i = 0; i < count; i++)
        p->rows[i] = rows_of(p, i);
    for (uint32_t most = MOST_ROWS;; most /= 2) {
        uint64_t total = 0;
        for (uint32_t i = 0; i < count; i++) {
            p->rows[i] = p->rows[i] < most ? p->rows[i] : most;
            total += colors_of(p->rows[i]);
        }
        if (total <= MOST_COLORS || most == 1)
            return total;
    }
}

/* ---- textures -------------------------------------------------------------------------------- */

static struct kiln_asset_image *load_texture(struct kiln_scene *scene, const struct painter *p,
                                             uint32_t number, const char *path,
                                             struct kiln_error *error)
{
    const struct kiln_texture *texture = &p->looks->textures[number];
    if (texture->byte_count > 0) {
        struct kiln_asset_image *image = kiln_asset_image_parse(
            p->looks->bytes + texture->first_byte, texture->byte_count, path, error);
        if (image && !kiln_budget_take(kiln_loader_budget(scene->loader), KILN_LIMIT_asset_pixels,
                                       (uint64_t)image->width * image->height, path, error))
            kiln_asset_image_destroy(&image);
        return image;
    }
    const char *slash = strrchr(path, '/');
    char *file = kiln_arena_format(scene->arena, "%.*s/%s", slash ? (int)(slash - path) : 1,
                                   slash ? path : ".", texture->file);
    if (!file || !kiln_scene_add_file(scene, file, "a texture of a mesh")) {
        kiln_error_no_memory(error, "reading a scene");
        return NULL;
    }
    return kiln_asset_image_load(scene->loader, file, error);
}

/* Loads the textures of colours that triangles show. A missing one shows white. */
static bool load_textures(struct kiln_scene *scene, struct painter *p, const char *path,
                          struct kiln_error *error)
{
    for (uint32_t i = 0; i < p->mesh->triangle_count; i++) {
        const struct kiln_material *material = material_of(p, i);
        const uint32_t number = material ? material->maps[KILN_USE_COLOR].texture : KILN_NO_TEXTURE;
        if (number == KILN_NO_TEXTURE || p->textures[number] ||
            p->looks->textures[number].is_missing)
            continue;
        p->textures[number] = load_texture(scene, p, number, path, error);
        if (!p->textures[number])
            return false;
    }
    return true;
}

/* ---- texels ---------------------------------------------------------------------------------- */

bool kiln_source_make_texels(struct kiln_arena *arena, struct kiln_source *source, uint64_t colors)
{
    source->texel_count = source->cells + (uint32_t)((colors + 3) / 4);
    source->texels = kiln_arena_alloc(arena, source->texel_count, sizeof *source->texels);
    return source->texels != NULL;
}

void kiln_source_set_color(struct kiln_source *source, uint32_t number, uint32_t color)
{
    memcpy((char *)&source->texels[source->cells + number / 4] + sizeof color * (number % 4),
           &color, sizeof color);
}

static void paint_triangles(const struct painter *p, struct kiln_source *source)
{
    uint32_t next = 0;
    for (uint32_t i = 0; i < source->cells; i++) {
        const struct kiln_material *material = material_of(p, i);
        const float4 *words = source->words + (size_t)i * source->words_of_cell;
        const uint32_t rows = p->rows[i];
        uint32_t corners[3];
        kiln_source_triangle(p->mesh, i, corners);
        source->texels[i] = UINT4(FLOAT_BITS(words[0].w), (uint32_t)words[1].w, next, rows);
        for (uint32_t row = 0; row < rows; row++) {
            for (uint32_t column = 0; row + column < rows; column++) {
                const float s = ((float)row + 1.0f / 3.0f) / (float)rows;
                const float t = ((float)column + 1.0f / 3.0f) / (float)rows;
                kiln_source_set_color(source, next++, color_at(p, material, corners, s, t));
            }
        }
    }
}

static void paint_vertices(const struct painter *p, struct kiln_source *source)
{
    for (uint32_t i = 0; i < source->cells; i++)
        source->texels[i] = UINT4(FLOAT_BITS(1.0f), i, i, 1);
    for (uint32_t i = 0; i < p->mesh->triangle_count; i++) {
        const struct kiln_material *material = material_of(p, i);
        const uint32_t *corners = p->mesh->triangles[i];
        for (int k = 0; k < 3; k++)
            kiln_source_set_color(
                source, corners[k],
                color_at(p, material, corners, k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f));
    }
}

static void finish(struct painter *p)
{
    for (uint32_t i = 0; p->textures && i < p->looks->texture_count; i++)
        kiln_asset_image_destroy(&p->textures[i]);
    free(p->textures);
    free(p->rows);
}

bool kiln_source_is_plain(const struct kiln_mesh *looks)
{
    bool plain = false;
    for (uint32_t i = 0; !looks->looks->colors && !plain && i < looks->triangle_count; i++)
        plain = looks->looks->of_triangles[i] == KILN_NO_MATERIAL;
    return plain;
}

bool kiln_source_color_mesh(struct kiln_scene *scene, const struct kiln_mesh *looks,
                            const char *path, enum kiln_source_on on, const float plain[3],
                            struct kiln_source *source, struct kiln_error *error)
{
    const bool vertices = on == KILN_ON_VERTICES;
    struct painter p = {.mesh = looks, .looks = looks->looks, .plain = plain};
    p.textures = calloc(p.looks->texture_count + 1u, sizeof *p.textures);
    p.rows = malloc(looks->triangle_count * sizeof *p.rows);
    bool ok = p.textures && p.rows;
    if (!ok) {
        kiln_error_no_memory(error, "%s", path);
        goto end;
    }
    ok = load_textures(scene, &p, path, error);
    if (!ok)
        goto end;
    const uint64_t colors = vertices ? looks->vertex_count : choose_rows(&p);
    ok = kiln_source_make_texels(scene->arena, source, colors) ||
         kiln_error_no_memory(error, "%s", path);
    if (ok && vertices)
        paint_vertices(&p, source);
    else if (ok)
        paint_triangles(&p, source);
end:
    finish(&p);
    return ok;
}

/* ---- one particle ---------------------------------------------------------------------------- */

float3 kiln_source_color(const struct kiln_source *source, uint32_t stream)
{
    const uint32_t turn = source_turn(stream, source->cells);
    uint4 cell = source->texels[turn];
    const uint32_t chosen = source_choose(stream, turn, BITS_FLOAT(cell.x), cell.y);
    cell = source->texels[chosen];
    uint32_t number = cell.z, color;
    if (cell.w > 1)
        number += source_color_of(source_spot_on_triangle(stream), cell.w);
    memcpy(&color,
           (const char *)&source->texels[source->cells + number / 4] + sizeof color * (number % 4),
           sizeof color);
    return FLOAT3(source_component(color, 0), source_component(color, 1),
                  source_component(color, 2));
}
