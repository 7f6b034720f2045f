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
#include "shared/exact.h"

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

static int by_number(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Finds the numbers of all materials that parts have, each once and in ascending order. Returns how
 * many there are. */
static size_t list_numbers(const struct decode_model *model, uint32_t none, uint32_t *numbers)
{
    size_t count = 0, kept = 0;
    for (size_t i = 0; i < model->part_count; i++) {
        const struct decode_model_mesh *mesh = &model->meshes[model->parts[i].mesh];
        if (mesh->triangle_count > 0 && mesh->material != none)
            numbers[count++] = mesh->material;
    }
    if (count > 0)
        qsort(numbers, count, sizeof *numbers, by_number);
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || numbers[i] != numbers[i - 1])
            numbers[kept++] = numbers[i];
    }
    return kept;
}

bool decode_assign_looks(struct decode_model *model, uint32_t none,
                         uint32_t numbers[KILN_MAX_MATERIALS], struct kiln_error *error)
{
    struct kiln_looks_result *looks = model->looks;
    uint32_t *all = malloc((model->part_count + 1) * sizeof *all);
    if (!all)
        return decode_out_of_memory(error);
    const size_t count = list_numbers(model, none, all);
    const size_t kept = count < KILN_MAX_MATERIALS ? count : KILN_MAX_MATERIALS;
    if (kept < count)
        decode_note(model->notes, "the mesh has %zu materials; those beyond %d are left out", count,
                    KILN_MAX_MATERIALS);
    for (size_t i = 0; i < kept; i++) {
        numbers[i] = all[i];
        looks->materials[i] = kiln_material_default();
    }
    looks->material_count = (uint32_t)kept;
    for (size_t i = 0; i < model->mesh_count; i++) {
        const uint32_t *found =
            kept > 0 ? bsearch(&model->meshes[i].material, numbers, kept, sizeof *all, by_number)
                     : NULL;
        model->meshes[i].look = found ? (uint16_t)(found - numbers) : KILN_NO_MATERIAL;
    }
    free(all);
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

float decode_light_of(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : exact_pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float decode_clamp(float number, float least, float most)
{
    return number > least ? (number < most ? number : most) : least;
}
