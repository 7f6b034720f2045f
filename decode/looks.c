/* This file fills in what materials of all formats have in common: which of them are used,
 * textures, which are named once however often they are used, and notes. A material never makes a
 * reader fail, unless memory is short: what cannot be kept is left out, with a note. */
#include "looks.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "decode.h"

void decode_note(char *notes, const char *format, ...)
{
    char text[KILN_MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    const size_t length = strlen(notes), more = strlen(text);
    if (strstr(notes, text) || length + more + 2 > KILN_MESSAGE_SIZE)
        return;
    snprintf(notes + length, KILN_MESSAGE_SIZE - length, "%s%s", length ? "\n" : "", text);
}

/* ---- materials ------------------------------------------------------------------------------- */

/* A material that a part has. */
struct use {
    uint32_t material, source;
};

static int by_material(const void *a, const void *b)
{
    const uint32_t x = ((const struct use *)a)->material, y = ((const struct use *)b)->material;
    return (x > y) - (x < y);
}

/* Finds all materials that parts have, each once and in their order. Returns how many there are. */
static size_t list_uses(const struct decode_model *model, uint32_t none, struct use *uses)
{
    size_t count = 0, kept = 0;
    for (size_t i = 0; i < model->part_count; i++) {
        const struct decode_model_mesh *mesh = &model->meshes[model->parts[i].mesh];
        if (mesh->triangle_count > 0 && mesh->source != none)
            uses[count++] = (struct use){mesh->material, mesh->source};
    }
    if (count > 0)
        qsort(uses, count, sizeof *uses, by_material);
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || by_material(&uses[i], &uses[i - 1]) != 0)
            uses[kept++] = uses[i];
    }
    return kept;
}

bool decode_assign_looks(struct decode_model *model, uint32_t none,
                         uint32_t sources[KILN_MAX_MATERIALS], struct kiln_error *error)
{
    struct kiln_looks_result *looks = model->looks;
    struct use *uses = malloc((model->part_count + 1) * sizeof *uses);
    if (!uses)
        return decode_out_of_memory(error);
    const size_t count = list_uses(model, none, uses);
    const size_t kept = count < KILN_MAX_MATERIALS ? count : KILN_MAX_MATERIALS;
    if (kept < count)
        decode_note(model->notes, "the mesh has %zu materials; those beyond %d are left out", count,
                    KILN_MAX_MATERIALS);
    for (size_t i = 0; i < kept; i++) {
        sources[i] = uses[i].source;
        looks->materials[i] = kiln_material_default();
    }
    looks->material_count = (uint32_t)kept;
    for (size_t i = 0; i < model->mesh_count; i++) {
        struct decode_model_mesh *mesh = &model->meshes[i];
        const struct use use = {mesh->material, mesh->source};
        const struct use *found = kept > 0 && mesh->source != none
                                      ? bsearch(&use, uses, kept, sizeof *uses, by_material)
                                      : NULL;
        mesh->look = found ? (uint16_t)(found - uses) : KILN_NO_MATERIAL;
    }
    free(uses);
    return true;
}

void decode_copy_name(const char *text, size_t length, char name[KILN_MATERIAL_NAME_SIZE])
{
    size_t kept = length < KILN_MATERIAL_NAME_SIZE ? length : KILN_MATERIAL_NAME_SIZE - 1;
    while (kept < length && kept > 0 && ((unsigned char)text[kept] & 0xc0) == 0x80)
        kept--;
    memcpy(name, text, kept);
    name[kept] = '\0';
}

/* ---- textures -------------------------------------------------------------------------------- */

static uint32_t add_texture(struct decode_model *model, const struct kiln_texture *texture)
{
    struct kiln_looks_result *looks = model->looks;
    for (uint32_t i = 0; i < looks->texture_count; i++) {
        const struct kiln_texture *other = &looks->textures[i];
        if (strcmp(other->file, texture->file) == 0 && other->first_byte == texture->first_byte &&
            other->byte_count == texture->byte_count)
            return i;
    }
    if (looks->texture_count == KILN_MAX_TEXTURES) {
        decode_note(model->notes, "the mesh has more than %d textures; the others are left out",
                    KILN_MAX_TEXTURES);
        return KILN_NO_TEXTURE;
    }
    looks->textures[looks->texture_count] = *texture;
    return looks->texture_count++;
}

uint32_t decode_add_file(struct decode_model *model, const char *path, size_t length)
{
    struct kiln_texture texture = {.byte_count = 0};
    const int shown = (int)(length < 200 ? length : 200);
    if (length == 0 || memchr(path, '\0', length) || length >= sizeof texture.file) {
        decode_note(model->notes,
                    "the mesh names a texture by a path that is empty, is longer than %zu bytes or "
                    "has a zero; it is left out",
                    sizeof texture.file - 1);
        return KILN_NO_TEXTURE;
    }
    memcpy(texture.file, path, length);
    if (!kiln_path_stays_below(texture.file)) {
        decode_note(model->notes,
                    "the mesh names the texture '%.*s'; it is left out, since files must lie in "
                    "the mesh's folder or below",
                    shown, path);
        return KILN_NO_TEXTURE;
    }
    return add_texture(model, &texture);
}

void decode_drop_textures(struct kiln_looks_result *looks)
{
    uint32_t numbers[KILN_MAX_TEXTURES] = {0}, kept = 0; /* from 1; 0: it is not used */
    for (size_t i = 0; i < (size_t)looks->material_count * KILN_MATERIAL_USES; i++) {
        const uint32_t texture =
            looks->materials[i / KILN_MATERIAL_USES].maps[i % KILN_MATERIAL_USES].texture;
        if (texture != KILN_NO_TEXTURE)
            numbers[texture] = 1;
    }
    for (uint32_t i = 0; i < looks->texture_count; i++) {
        if (numbers[i] == 0)
            continue;
        looks->textures[kept] = looks->textures[i];
        numbers[i] = ++kept;
    }
    looks->texture_count = kept;
    for (size_t i = 0; i < (size_t)looks->material_count * KILN_MATERIAL_USES; i++) {
        uint32_t *texture =
            &looks->materials[i / KILN_MATERIAL_USES].maps[i % KILN_MATERIAL_USES].texture;
        if (*texture != KILN_NO_TEXTURE)
            *texture = numbers[*texture] - 1;
    }
}

uint32_t decode_add_bytes(struct decode_model *model, const void *bytes, size_t size)
{
    struct kiln_looks_result *looks = model->looks;
    if (size == 0 || size > KILN_MAX_TEXTURE_BYTES - looks->byte_count) {
        decode_note(model->notes,
                    "a texture of %zu bytes in the mesh file is left out: allowed are 1 to %d "
                    "bytes of all textures together",
                    size, KILN_MAX_TEXTURE_BYTES);
        return KILN_NO_TEXTURE;
    }
    unsigned char *more = realloc(looks->bytes, looks->byte_count + size);
    if (!more) {
        decode_note(model->notes, "a texture is left out, since memory is short");
        return KILN_NO_TEXTURE;
    }
    looks->bytes = more;
    memcpy(more + looks->byte_count, bytes, size);
    const struct kiln_texture texture = {.first_byte = looks->byte_count,
                                         .byte_count = (uint32_t)size};
    const uint32_t number = add_texture(model, &texture);
    looks->byte_count += number != KILN_NO_TEXTURE ? (uint32_t)size : 0;
    return number;
}

/* ---- numbers --------------------------------------------------------------------------------- */

float decode_clamp(float number, float least, float most)
{
    return number > least ? (number < most ? number : most) : least;
}

void decode_put_color(const float encoded[3], float alpha, float out[4])
{
    for (int c = 0; c < 3; c++)
        out[c] = kiln_light_of_srgb(decode_clamp(encoded[c], 0, 1));
    out[3] = decode_clamp(alpha, 0, 1);
}
