/* This file reads the primitives of glTF files that Draco compresses, by the module kiln-draco.so
 * beside kiln-decode. The stream says how many points and triangles there are; the accessors of the
 * file only say which types its numbers have. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draco_module.h"
#include "gltf.h"
#include "module.h"

static struct {
    __typeof__(kiln_draco_read) *kiln_draco_read;
} module;

bool decode_draco_begin(struct kiln_error *error)
{
    static const struct kiln_library_function functions[] = {
        {"kiln_draco_read", &module.kiln_draco_read}};
    return decode_module_open("kiln-draco.so", "libdraco7", functions, 1, error);
}

bool decode_draco_is_ready(void)
{
    return module.kiln_draco_read != NULL;
}

/* The enum numbers the attributes of glTF that the module is asked for. */
enum { POSITION, NORMAL, TEXCOORD, JOINTS, WEIGHTS, COLOR, SECOND_TEXCOORD, ATTRIBUTES };

static const struct {
    const char *key;
    uint32_t components;
} wanted[ATTRIBUTES] = {[POSITION] = {"POSITION", 3},         [NORMAL] = {"NORMAL", 3},
                        [TEXCOORD] = {"TEXCOORD_0", 2},       [JOINTS] = {"JOINTS_0", 4},
                        [WEIGHTS] = {"WEIGHTS_0", 4},         [COLOR] = {"COLOR_0", 4}, /* or 3 */
                        [SECOND_TEXCOORD] = {"TEXCOORD_1", 2}};

/* Returns what the integers of an accessor are divided by; 0: they are not. */
static double most_of(const struct gltf *g, const json_t *attributes, const char *key)
{
    static const struct {
        uint32_t type;
        double most;
    } types[] = {{5120, 127.0}, {5121, 255.0}, {5122, 32767.0}, {5123, 65535.0}};
    uint32_t number = 0, type = 0;
    if (!gltf_index(gltf_member(attributes, key), &number))
        return 0.0;
    const json_t *accessor = gltf_element(g, GLTF_ACCESSORS, number);
    if (!json_is_true(gltf_member(accessor, "normalized")) ||
        !gltf_index(gltf_member(accessor, "componentType"), &type))
        return 0.0;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        if (types[i].type == type)
            return types[i].most;
    }
    return 0.0;
}

static bool decompress(struct gltf *g, struct kiln_draco_request *request)
{
    char message[200] = "";
    switch (module.kiln_draco_read(request, message, sizeof message)) {
    case KILN_DRACO_DONE:
        return true;
    case KILN_DRACO_NO_MEMORY:
        return decode_out_of_memory(g->error);
    case KILN_DRACO_TOO_LARGE:
        return decode_refuse_size(g->error);
    case KILN_DRACO_BROKEN:
        break;
    }
    return GLTF_SET(g, "triangles that Draco compresses are broken or cut short (%s)", message);
}

/* Gives a primitive the joints and weights of a stream. */
static bool put_weights(struct gltf *g, const float *joints, float *weights,
                        struct gltf_primitive *primitive)
{
    const size_t count = (size_t)primitive->vertex_count * 4;
    uint32_t *numbers = malloc((count + 1) * sizeof *numbers);
    if (!numbers)
        return decode_out_of_memory(g->error);
    for (size_t i = 0; i < count; i++)
        numbers[i] = joints[i] > 0.0f && joints[i] < 65535.0f ? (uint32_t)joints[i] : 0;
    uint32_t *const all_joints[1] = {numbers};
    float *const all_weights[1] = {weights};
    const bool ok = gltf_put_weights(g, primitive, all_joints, all_weights, 1);
    free(numbers);
    return ok;
}

/* Takes arrays out of an answer. */
static bool take(struct gltf *g, struct kiln_draco_request *request, bool weights,
                 struct gltf_primitive *primitive)
{
    struct kiln_draco_attribute *of = request->attributes;
    primitive->vertex_count = request->point_count;
    primitive->positions = (float(*)[3])of[POSITION].values;
    primitive->normals = (float(*)[3])of[NORMAL].values;
    primitive->uvs = (float(*)[2])of[TEXCOORD].values;
    primitive->triangles = request->triangles;
    primitive->second_uvs = (float(*)[2])of[SECOND_TEXCOORD].values;
    of[POSITION].values = of[NORMAL].values = of[TEXCOORD].values = NULL;
    of[SECOND_TEXCOORD].values = NULL;
    request->triangles = NULL;
    if (!primitive->positions)
        return GLTF_SET(g, "triangles that Draco compresses have no positions");
    primitive->triangle_count = request->triangle_count;
    if (of[COLOR].values && !gltf_put_colors(g, of[COLOR].values, of[COLOR].components, primitive))
        return false;
    return !weights || !of[JOINTS].values || !of[WEIGHTS].values ||
           put_weights(g, of[JOINTS].values, of[WEIGHTS].values, primitive);
}

/* Returns whether an attribute of `wanted` is to be read. */
static bool is_wanted(const struct gltf *g, int attribute, bool uvs, bool weights)
{
    switch (attribute) {
    case TEXCOORD:
        return uvs;
    case JOINTS:
    case WEIGHTS:
        return weights;
    case COLOR:
    case SECOND_TEXCOORD:
        return g->wanted->materials;
    default:
        return true;
    }
}

bool gltf_read_draco(struct gltf *g, const json_t *json, const json_t *extension, bool uvs,
                     bool weights, struct gltf_primitive *primitive)
{
    const json_t *ids = gltf_member(extension, "attributes");
    const json_t *attributes = gltf_member(json, "attributes");
    struct kiln_draco_attribute of[ATTRIBUTES];
    uint32_t number = 0;
    struct gltf_view view;
    if (!gltf_reference(g, extension, "bufferView", GLTF_VIEWS, &number))
        return false;
    if (number == GLTF_NONE)
        return GLTF_SET(g, "triangles that Draco compresses have no bufferView");
    if (!gltf_find_view(g, number, &view))
        return false;
    for (int i = 0; i < ATTRIBUTES; i++) {
        of[i] = (struct kiln_draco_attribute){.id = UINT32_MAX,
                                              .components = wanted[i].components,
                                              .most = most_of(g, attributes, wanted[i].key)};
        if (is_wanted(g, i, uvs, weights))
            (void)gltf_index(gltf_member(ids, wanted[i].key), &of[i].id);
    }
    of[COLOR].components = gltf_color_width(g, attributes);
    struct kiln_draco_request request = {.bytes = view.bytes,
                                         .size = view.size,
                                         .most_points = KILN_MAX_MESH_VERTICES,
                                         .most_triangles = KILN_MAX_MESH_TRIANGLES,
                                         .attributes = of,
                                         .attribute_count = ATTRIBUTES};
    const bool ok = decompress(g, &request) && take(g, &request, weights, primitive);
    for (int i = 0; i < ATTRIBUTES; i++)
        free(of[i].values);
    free(request.triangles);
    return ok;
}
