/* This file reads the materials of glTF files, their textures, and the colours of vertices. Nothing
 * in it makes the reader fail but vertices that are not there: a material or a texture that the
 * file describes wrongly is left out, or keeps its default, as a mesh without its materials is
 * shown. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gltf.h"
#include "looks.h"

struct reading {
    struct gltf *g;
    struct decode_model *model;
    uint32_t *of_images; /* the texture of each image of the file, from 1; 0: not yet */
};

/* ---- numbers --------------------------------------------------------------------------------- */

/* Gets a number between limits; `otherwise` if there is none. */
static float get_number(const json_t *object, const char *key, float otherwise, float least,
                        float most)
{
    double number = 0.0;
    if (!gltf_number(gltf_member(object, key), &number))
        return otherwise;
    return number > (double)least ? (number < (double)most ? (float)number : most) : least;
}

/* Gets the numbers of an array from 0 to 1, as far as it has them. */
static void get_numbers(const json_t *object, const char *key, float *out, uint32_t count)
{
    const json_t *array = gltf_member(object, key);
    for (uint32_t i = 0; i < count; i++) {
        double number = 0.0;
        if (gltf_number(gltf_item(array, i), &number))
            out[i] = decode_clamp((float)number, 0, 1);
    }
}

/* Returns the element of a list that a member names by its number, or NULL. */
static const json_t *element_of(const struct gltf *g, const json_t *object, const char *key,
                                enum gltf_list_name list, uint32_t *number)
{
    *number = GLTF_NONE;
    (void)gltf_index(gltf_member(object, key), number);
    return gltf_element(g, list, *number);
}

/* ---- pictures -------------------------------------------------------------------------------- */

/* Adds a picture in a data URI or in another file. */
static uint32_t add_uri(struct reading *r, const json_t *value)
{
    struct gltf_bytes data = {.size = 0};
    struct kiln_error ignored = {0}, *kept = r->g->error;
    size_t length = 0;
    uint32_t texture = KILN_NO_TEXTURE;
    r->g->error = &ignored;
    char *uri = gltf_copy_uri(r->g, value, &length);
    if (uri && length >= 5 && strncasecmp(uri, "data:", 5) == 0) {
        if (gltf_decode_data(r->g, uri, length, &data))
            texture = decode_add_bytes(r->model, data.bytes, data.size);
        else
            decode_note(r->model->notes, "a texture is left out: its data URI is broken");
    } else if (uri) {
        length = gltf_decode_percents(uri, length);
        texture = decode_add_file(r->model, uri, length);
    }
    r->g->error = kept;
    free(uri);
    return texture;
}

/* Adds a picture in a buffer view. */
static uint32_t add_view(struct reading *r, uint32_t number)
{
    struct kiln_error reason = {0}, *kept = r->g->error;
    struct gltf_view view = {.size = 0};
    r->g->error = &reason;
    const bool found = gltf_find_view(r->g, number, &view);
    r->g->error = kept;
    if (found)
        return decode_add_bytes(r->model, view.bytes, view.size);
    decode_note(r->model->notes, "a texture is left out: %.500s", reason.message);
    return KILN_NO_TEXTURE;
}

/* Returns the texture of an image of the file. */
static uint32_t add_image(struct reading *r, uint32_t number)
{
    const struct gltf *g = r->g;
    const json_t *image = gltf_element(g, GLTF_IMAGES, number);
    if (!image)
        return KILN_NO_TEXTURE;
    if (r->of_images[number] == 0) {
        const json_t *uri = gltf_member(image, "uri");
        uint32_t view = 0, texture = KILN_NO_TEXTURE;
        if (uri)
            texture = add_uri(r, uri);
        else if (element_of(g, image, "bufferView", GLTF_VIEWS, &view))
            texture = add_view(r, view);
        r->of_images[number] = texture == KILN_NO_TEXTURE ? UINT32_MAX : texture + 1;
    }
    return r->of_images[number] == UINT32_MAX ? KILN_NO_TEXTURE : r->of_images[number] - 1;
}

/* Returns the picture of a texture of the file: its own or, if it has none that all programs read,
 * that of an extension. */
static uint32_t add_texture(struct reading *r, const json_t *texture)
{
    static const char *const others[] = {"EXT_texture_webp", "EXT_texture_avif",
                                         "KHR_texture_basisu", "MSFT_texture_dds"};
    const struct gltf *g = r->g;
    uint32_t image = 0;
    const json_t *found = element_of(g, texture, "source", GLTF_IMAGES, &image);
    for (size_t i = 0; !found && i < sizeof others / sizeof *others; i++)
        found = element_of(g, gltf_extension(texture, others[i]), "source", GLTF_IMAGES, &image);
    return add_image(r, image);
}

/* ---- maps ------------------------------------------------------------------------------------ */

enum { NEAREST = 9728, CLAMP_TO_EDGE = 33071, MIRRORED_REPEAT = 33648 }; /* numbers of OpenGL */

static uint32_t wrap_of(const json_t *sampler, const char *key)
{
    uint32_t number = 0;
    if (!gltf_index(gltf_member(sampler, key), &number))
        return KILN_WRAP_REPEAT;
    return number == CLAMP_TO_EDGE     ? KILN_WRAP_CLAMP
           : number == MIRRORED_REPEAT ? KILN_WRAP_MIRROR
                                       : KILN_WRAP_REPEAT;
}

static void read_sampler(const struct gltf *g, const json_t *texture, struct kiln_material_map *map)
{
    uint32_t number = 0, filter = 0;
    const json_t *sampler = element_of(g, texture, "sampler", GLTF_SAMPLERS, &number);
    map->wrap[0] = wrap_of(sampler, "wrapS");
    map->wrap[1] = wrap_of(sampler, "wrapT");
    map->is_nearest = gltf_index(gltf_member(sampler, "magFilter"), &filter) && filter == NEAREST;
}

static void read_transform(const json_t *info, struct kiln_material_map *map)
{
    double rows[2][3];
    if (!gltf_get_transform(info, rows))
        return;
    for (int i = 0; i < 6; i++) {
        const double most = (double)KILN_MAX_MATERIAL_NUMBER, number = rows[i / 3][i % 3];
        map->rows[i / 3][i % 3] = (float)(number > -most ? (number < most ? number : most) : -most);
    }
}

/* Reads how a material uses a texture. info: what the material says of it. */
static void read_map(struct reading *r, const json_t *info, struct kiln_material_map *map)
{
    struct gltf *g = r->g;
    uint32_t number = 0, set = 0;
    const json_t *texture = element_of(g, info, "index", GLTF_TEXTURES, &number);
    if (!texture)
        return;
    const json_t *transform = gltf_extension(info, "KHR_texture_transform");
    if (!gltf_index(gltf_member(transform, "texCoord"), &set))
        (void)gltf_index(gltf_member(info, "texCoord"), &set);
    if (set >= KILN_UV_SETS) {
        decode_note(r->model->notes,
                    "a texture is left out that is laid by set %u of texture coordinates; allowed "
                    "are 0 to %d",
                    set, KILN_UV_SETS - 1);
        return;
    }
    map->texture = add_texture(r, texture);
    map->uv_set = set;
    map->strength =
        get_number(info, "scale", 1, -KILN_MAX_MATERIAL_NUMBER, KILN_MAX_MATERIAL_NUMBER);
    read_sampler(g, texture, map);
    read_transform(info, map);
}

/* ---- materials ------------------------------------------------------------------------------- */

static void read_metal(struct reading *r, const json_t *looks, struct kiln_material *out)
{
    float color[4] = {1, 1, 1, 1};
    get_numbers(looks, "baseColorFactor", color, 4);
    memcpy(out->color, color, sizeof out->color);
    out->alpha = color[3];
    out->metalness = get_number(looks, "metallicFactor", 1, 0, 1);
    out->roughness = get_number(looks, "roughnessFactor", 1, 0, 1);
    read_map(r, gltf_member(looks, "baseColorTexture"), &out->maps[KILN_USE_COLOR]);
    const json_t *both = gltf_member(looks, "metallicRoughnessTexture");
    read_map(r, both, &out->maps[KILN_USE_ROUGHNESS]);
    read_map(r, both, &out->maps[KILN_USE_METALNESS]);
    out->maps[KILN_USE_ROUGHNESS].channel = KILN_TEXEL_GREEN;
    out->maps[KILN_USE_METALNESS].channel = KILN_TEXEL_BLUE;
}

/* Returns how bright a colour looks, as the conversion of Khronos weighs it. */
static float brightness_of(const float c[3])
{
    return sqrtf(0.299f * c[0] * c[0] + 0.587f * c[1] * c[1] + 0.114f * c[2] * c[2]);
}

static float strongest_of(const float c[3])
{
    const float two = c[0] > c[1] ? c[0] : c[1];
    return two > c[2] ? two : c[2];
}

static const float DIELECTRIC = 0.04f; /* what a surface that is no metal reflects */

/* Finds the metalness of a surface that reflects `diffuse` and `specular` light. rest: the part of
 * light that is not reflected as specular light. */
static float metalness_of(float diffuse, float specular, float rest)
{
    if (specular < DIELECTRIC)
        return 0;
    const float b = diffuse * rest / (1 - DIELECTRIC) + specular - 2 * DIELECTRIC;
    const float c = DIELECTRIC - specular;
    const float root = b * b - 4 * DIELECTRIC * c;
    return decode_clamp((sqrtf(root > 0 ? root : 0) - b) / (2 * DIELECTRIC), 0, 1);
}

/* Reads a material of KHR_materials_pbrSpecularGlossiness. Its numbers are converted as Khronos'
 * example does (convert-between-workflows, in the extension's folder); its textures cannot be, so
 * that of diffuse light is taken for the base colour, and glossiness for the inverse of roughness.
 */
static void read_gloss(struct reading *r, const json_t *gloss, struct kiln_material *out)
{
    const float least = 1e-6f;
    float diffuse[4] = {1, 1, 1, 1}, specular[3] = {1, 1, 1};
    get_numbers(gloss, "diffuseFactor", diffuse, 4);
    get_numbers(gloss, "specularFactor", specular, 3);
    const float rest = 1 - strongest_of(specular);
    const float metal = metalness_of(brightness_of(diffuse), brightness_of(specular), rest);
    const float no_metal = 1 - metal > least ? 1 - metal : least;
    for (int c = 0; c < 3; c++) {
        const float from_diffuse = diffuse[c] * rest / (1 - DIELECTRIC) / no_metal;
        const float from_specular =
            (specular[c] - DIELECTRIC * (1 - metal)) / (metal > least ? metal : least);
        out->color[c] =
            decode_clamp(from_diffuse + (from_specular - from_diffuse) * metal * metal, 0, 1);
    }
    out->alpha = diffuse[3];
    out->metalness = metal;
    out->roughness = 1 - get_number(gloss, "glossinessFactor", 1, 0, 1);
    read_map(r, gltf_member(gloss, "diffuseTexture"), &out->maps[KILN_USE_COLOR]);
    struct kiln_material_map *map = &out->maps[KILN_USE_ROUGHNESS];
    read_map(r, gltf_member(gloss, "specularGlossinessTexture"), map);
    map->channel = KILN_TEXEL_ALPHA;
    map->is_inverse = map->texture != KILN_NO_TEXTURE;
    if (map->is_inverse)
        out->roughness = 1; /* a product of glossinesses is none of roughnesses */
}

static void read_emission(struct reading *r, const json_t *material, struct kiln_material *out)
{
    const json_t *extension = gltf_extension(material, "KHR_materials_emissive_strength");
    const float strength = get_number(extension, "emissiveStrength", 1, 0, KILN_MAX_EMISSION);
    get_numbers(material, "emissiveFactor", out->emission, 3);
    for (int c = 0; c < 3; c++)
        out->emission[c] *= strength;
    read_map(r, gltf_member(material, "emissiveTexture"), &out->maps[KILN_USE_EMISSION]);
}

static void read_material(struct reading *r, const json_t *material, struct kiln_material *out)
{
    char name[4 * KILN_MATERIAL_NAME_SIZE] = "";
    (void)gltf_text(gltf_member(material, "name"), name, sizeof name);
    decode_copy_name(name, strlen(name), out->name);
    const json_t *gloss = gltf_extension(material, "KHR_materials_pbrSpecularGlossiness");
    if (gloss)
        read_gloss(r, gloss, out);
    else
        read_metal(r, gltf_member(material, "pbrMetallicRoughness"), out);
    read_map(r, gltf_member(material, "normalTexture"), &out->maps[KILN_USE_NORMAL]);
    read_emission(r, material, out);
    const json_t *mode = gltf_member(material, "alphaMode");
    out->alpha_mode = gltf_is(mode, "MASK")    ? KILN_ALPHA_MASK
                      : gltf_is(mode, "BLEND") ? KILN_ALPHA_BLEND
                                               : KILN_ALPHA_OPAQUE;
    out->cutoff = get_number(material, "alphaCutoff", 0.5f, 0, KILN_MAX_MATERIAL_NUMBER);
    out->is_two_sided = json_is_true(gltf_member(material, "doubleSided"));
    out->is_unlit = gltf_extension(material, "KHR_materials_unlit") != NULL;
}

bool gltf_put_materials(struct gltf *g, struct decode_model *model)
{
    uint32_t numbers[KILN_MAX_MATERIALS];
    struct reading r = {.g = g, .model = model};
    if (!model->looks)
        return true;
    if (!decode_assign_looks(model, g->lists[GLTF_MATERIALS].count, numbers, g->error))
        return false;
    r.of_images = calloc((size_t)g->lists[GLTF_IMAGES].count + 1, sizeof *r.of_images);
    if (!r.of_images)
        return decode_out_of_memory(g->error);
    for (uint32_t i = 0; i < model->looks->material_count; i++)
        read_material(&r, gltf_element(g, GLTF_MATERIALS, numbers[i]), &model->looks->materials[i]);
    free(r.of_images);
    return true;
}

/* ---- vertices -------------------------------------------------------------------------------- */

uint32_t gltf_color_width(const struct gltf *g, const json_t *attributes)
{
    uint32_t number = 0;
    const json_t *accessor = element_of(g, attributes, "COLOR_0", GLTF_ACCESSORS, &number);
    return gltf_is(gltf_member(accessor, "type"), "VEC3") ? 3 : 4;
}

bool gltf_put_colors(struct gltf *g, const float *colors, uint32_t width,
                     struct gltf_primitive *primitive)
{
    const size_t count = primitive->vertex_count;
    primitive->colors = malloc((count + 1) * sizeof *primitive->colors);
    if (!primitive->colors)
        return decode_out_of_memory(g->error);
    for (size_t i = 0; i < count; i++) {
        for (uint32_t c = 0; c < 4; c++)
            primitive->colors[i][c] = c < width ? decode_clamp(colors[width * i + c], 0, 1) : 1;
    }
    return true;
}

/* Texture coordinates that are no numbers become 0, as in OBJ and PLY: triangles without a place in
 * the texture are no reason to lose the mesh, or all its materials. */
void gltf_bound_uvs(float (*uvs)[2], size_t count)
{
    for (size_t i = 0; uvs && i < 2 * count; i++)
        uvs[i / 2][i % 2] = isfinite(uvs[i / 2][i % 2]) ? uvs[i / 2][i % 2] : 0.0f;
}

bool gltf_read_colors(struct gltf *g, const json_t *attributes, struct gltf_range range,
                      struct gltf_primitive *primitive)
{
    uint32_t accessor = 0;
    if (!g->wanted->materials)
        return true;
    if (element_of(g, attributes, "TEXCOORD_1", GLTF_ACCESSORS, &accessor)) {
        primitive->second_uvs = (float(*)[2])gltf_read(g, accessor, "VEC2", range);
        if (!primitive->second_uvs)
            return false;
        gltf_bound_uvs(primitive->second_uvs, range.count);
    }
    if (!element_of(g, attributes, "COLOR_0", GLTF_ACCESSORS, &accessor))
        return true;
    const uint32_t width = gltf_color_width(g, attributes);
    float *colors = gltf_read(g, accessor, width == 3 ? "VEC3" : "VEC4", range);
    const bool ok = colors && gltf_put_colors(g, colors, width, primitive);
    free(colors);
    return ok;
}
