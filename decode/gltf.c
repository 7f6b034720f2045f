/* This file reads glTF 2 documents: it finds the JSON of a text or binary file, checks the version
 * and the extensions that the file requires, and has the other files beside it (gltf.h) make kiln's
 * arrays. glTF 1 is another format, which is refused by its name. */
#include "gltf.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "looks.h"

/* ---- parts of the document ------------------------------------------------------------------- */

const json_t *gltf_element(const struct gltf *g, enum gltf_list_name list, uint32_t number)
{
    return gltf_item(g->lists[list].array, number);
}

static const char *const list_keys[GLTF_LISTS] = {
    [GLTF_ACCESSORS] = "accessors", [GLTF_ANIMATIONS] = "animations", [GLTF_BUFFERS] = "buffers",
    [GLTF_CAMERAS] = "cameras",     [GLTF_IMAGES] = "images",         [GLTF_SAMPLERS] = "samplers",
    [GLTF_TEXTURES] = "textures",   [GLTF_MATERIALS] = "materials",   [GLTF_MESHES] = "meshes",
    [GLTF_NODES] = "nodes",         [GLTF_SCENES] = "scenes",         [GLTF_SKINS] = "skins",
    [GLTF_VIEWS] = "bufferViews"};

bool gltf_reference(struct gltf *g, const json_t *object, const char *key, enum gltf_list_name list,
                    uint32_t *number)
{
    const json_t *value = gltf_member(object, key);
    *number = GLTF_NONE;
    if (!value || (gltf_index(value, number) && *number < g->lists[list].count))
        return true;
    return GLTF_SET(g, "a member '%s' is no number of an element of '%s', of which there are %u",
                    key, list_keys[list], g->lists[list].count);
}

const json_t *gltf_extension(const json_t *object, const char *name)
{
    const json_t *found = gltf_member(gltf_member(object, "extensions"), name);
    return json_is_object(found) ? found : NULL;
}

bool gltf_requires(const struct gltf *g, const char *extension)
{
    const json_t *list = gltf_member(g->root, "extensionsRequired");
    size_t i_at = 0;
    for (const json_t *i; (i = gltf_item(list, i_at)); i_at++) {
        if (gltf_is(i, extension))
            return true;
    }
    return false;
}

void gltf_note(struct gltf *g, const char *text)
{
    decode_note(g->notes, "%s", text);
}

/* ---- extensions ------------------------------------------------------------------------------ */

/* Extensions that say how vertices, nodes or clips are stored, and that are read. */
static const char *const supported[] = {
    "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "KHR_draco_mesh_compression",
    "KHR_meshopt_compression", "KHR_mesh_quantization",   "KHR_texture_transform",
};

/* Returns whether an extension concerns how surfaces look, light, or data about the file, none of
 * which changes where vertices are. Such extensions are called after what they concern. */
static bool is_of_looks(const char *name)
{
    static const char *const words[] = {"material", "texture", "light", "technique", "environment",
                                        "metadata", "xmp",     "audio", "mdl",       "packing"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strcasestr(name, words[i]))
            return true;
    }
    return false;
}

static bool check_extension(struct gltf *g, const json_t *value)
{
    char name[100], note[256];
    if (gltf_text(value, name, sizeof name) >= sizeof name)
        return GLTF_SET(g, "the file requires an extension whose name is longer than %zu bytes",
                        sizeof name - 1);
    for (size_t i = 0; i < sizeof supported / sizeof *supported; i++) {
        if (strcmp(name, supported[i]) == 0)
            return true;
    }
    if (!is_of_looks(name))
        return GLTF_SET(g, "the file requires the extension '%s', which kiln does not read", name);
    snprintf(note, sizeof note,
             "the file requires the extension '%s', which kiln does not read: the mesh has its "
             "shape, and may look different",
             name);
    gltf_note(g, note);
    return true;
}

static bool check_extensions(struct gltf *g)
{
    const json_t *list = gltf_member(g->root, "extensionsRequired");
    size_t i_at = 0;
    for (const json_t *i; (i = gltf_item(list, i_at)); i_at++) {
        if (!check_extension(g, i))
            return false;
    }
    g->needs_meshopt =
        gltf_requires(g, "EXT_meshopt_compression") || gltf_requires(g, "KHR_meshopt_compression");
    g->needs_draco = gltf_requires(g, "KHR_draco_mesh_compression");
    return true;
}

/* ---- versions -------------------------------------------------------------------------------- */

static bool refuse_version(const struct gltf *g, const char *found)
{
    if (found[0] != '1' || (found[1] != '\0' && found[1] != '.'))
        return GLTF_SET(g, "the file is of glTF version %.20s; kiln reads version 2", found);
    return GLTF_SET(g, "the file is of glTF version 1; kiln reads version 2, to which the program "
                       "gltf-pipeline of npm converts it: gltf-pipeline -i OLD -o NEW");
}

/* Checks the version that is the least for a reader to know, or that of the file. */
static bool check_version(struct gltf *g)
{
    char text[32] = "";
    const json_t *asset = gltf_member(g->root, "asset");
    const json_t *version = gltf_member(asset, "minVersion");
    if (!version)
        version = gltf_member(asset, "version");
    if (gltf_text(version, text, sizeof text) == 0) {
        /* the first files of version 1 have no `asset`, or one without a version */
        const bool is_first = json_is_object(gltf_member(g->root, "meshes"));
        return is_first ? refuse_version(g, "1")
                        : GLTF_SET(g, "the file does not say of which version of glTF it is: "
                                      "'asset.version' is missing; allowed is \"2.0\"");
    }
    return (text[0] == '2' && text[1] == '.') || strcmp(text, "2") == 0 || refuse_version(g, text);
}

/* ---- the file -------------------------------------------------------------------------------- */

enum { GLB_HEADER = 12, CHUNK_HEADER = 8 };

static uint32_t word_at(const unsigned char *b)
{
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* Finds the JSON of a binary file, and its buffer. */
static bool find_chunks(struct gltf *g, const char **json, size_t *size)
{
    const unsigned char *bytes = g->wanted->bytes;
    const size_t all = g->wanted->size;
    char version[16];
    if (all < GLB_HEADER + CHUNK_HEADER || memcmp(bytes, "glTF", 4) != 0)
        return GLTF_SET(g, "the contents of the file are not those of a .glb file");
    if (word_at(bytes + 4) != 2) {
        snprintf(version, sizeof version, "%u", word_at(bytes + 4));
        return refuse_version(g, version);
    }
    if (word_at(bytes + 8) > all)
        return GLTF_SET(g, "the file is cut short: it has %zu bytes, and its header says %u", all,
                        word_at(bytes + 8));
    const size_t length = word_at(bytes + GLB_HEADER), start = GLB_HEADER + CHUNK_HEADER;
    if (memcmp(bytes + GLB_HEADER + 4, "JSON", 4) != 0 || length > all - start)
        return GLTF_SET(g, "the file is cut short, or its first chunk is not the JSON");
    *json = (const char *)bytes + start;
    *size = length;
    const size_t next = start + length;
    if (all - next < CHUNK_HEADER || memcmp(bytes + next + 4, "BIN\0", 4) != 0)
        return true;
    const size_t binary = word_at(bytes + next), left = all - next - CHUNK_HEADER;
    g->chunk.bytes = bytes + next + CHUNK_HEADER;
    g->chunk.size = binary;
    return binary <= left ||
           GLTF_SET(g, "the file is cut short: its binary chunk has %zu bytes of %zu", left,
                    binary);
}

static bool find_json(struct gltf *g, const char **json, size_t *size)
{
    *json = g->wanted->bytes;
    *size = g->wanted->size;
    if (g->wanted->format == KILN_MESH_GLB && !find_chunks(g, json, size))
        return false;
    /* some programs pad chunks with zeros instead of spaces */
    while (*size > 0 && (*json)[*size - 1] == '\0')
        --*size;
    return true;
}

static bool read_document(struct gltf *g)
{
    const char *text = NULL;
    size_t size = 0;
    if (!find_json(g, &text, &size))
        return false;
    g->root = gltf_json_read(text, size, g->error);
    if (!g->root)
        return false;
    if (!json_is_object(g->root))
        return GLTF_SET(g, "the JSON is no object");
    if (!check_version(g) || !check_extensions(g))
        return false;
    for (int i = 0; i < GLTF_LISTS; i++) {
        const json_t *array = gltf_member(g->root, list_keys[i]);
        g->lists[i] = (struct gltf_list){array, gltf_size(array)};
    }
    return true;
}

/* ---- Draco ----------------------------------------------------------------------------------- */

/* Returns whether a primitive's own accessors have its data, so that those of Draco are not needed.
 */
static bool has_own_data(const struct gltf *g, const json_t *primitive)
{
    const json_t *attributes = gltf_member(primitive, "attributes");
    uint32_t number = 0;
    if (g->needs_draco || !gltf_index(gltf_member(attributes, "POSITION"), &number))
        return false;
    const json_t *accessor = gltf_element(g, GLTF_ACCESSORS, number);
    return gltf_member(accessor, "bufferView") != NULL;
}

const json_t *gltf_draco_of(const struct gltf *g, const json_t *primitive)
{
    const json_t *found = gltf_extension(primitive, "KHR_draco_mesh_compression");
    return !found || has_own_data(g, primitive) ? NULL : found;
}

static bool has_draco(const struct gltf *g)
{
    for (uint32_t i = 0; i < g->lists[GLTF_MESHES].count; i++) {
        const json_t *list = gltf_member(gltf_element(g, GLTF_MESHES, i), "primitives");
        size_t p_at = 0;
        for (const json_t *p; (p = gltf_item(list, p_at)); p_at++) {
            if (gltf_draco_of(g, p) != NULL)
                return true;
        }
    }
    return false;
}

/* ---- all of it ------------------------------------------------------------------------------- */

static void finish(struct gltf *g)
{
    for (uint32_t i = 0; g->buffers && i < g->lists[GLTF_BUFFERS].count; i++)
        free(g->buffers[i].owned);
    for (uint32_t i = 0; g->views && i < g->lists[GLTF_VIEWS].count; i++)
        free(g->views[i].owned);
    free(g->buffers);
    free(g->views);
    free(g->nodes);
    free(g->order);
    gltf_json_free(&g->root);
}

static bool make_surface(struct gltf *g, struct kiln_mesh_result *result)
{
    struct decode_model model = {.looks = g->wanted->materials ? &result->looks : NULL,
                                 .notes = result->notes};
    const bool ok = gltf_still(g, &model) && gltf_put_materials(g, &model) &&
                    decode_surface(g->wanted, &model, result, g->error);
    decode_model_finish(&model);
    return ok;
}

/* Counts the morph targets of the meshes that the scene shows. Primitives of a mesh have the same.
 */
static uint32_t count_targets(const struct gltf *g)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < g->order_count; i++) {
        const struct gltf_node *node = &g->nodes[g->order[i]];
        const json_t *mesh = gltf_element(g, GLTF_MESHES, node->shown ? node->mesh : GLTF_NONE);
        const json_t *list = gltf_member(mesh, "primitives");
        count += gltf_size(gltf_member(gltf_item(list, 0), "targets"));
    }
    return count < UINT32_MAX ? (uint32_t)count : UINT32_MAX;
}

bool decode_gltf(const struct decode_mesh *mesh, struct kiln_mesh_result *result, bool *needs_other,
                 struct kiln_error *error)
{
    struct gltf g = {.wanted = mesh, .error = error, .notes = result->notes};
    bool ok = read_document(&g);
    *needs_other = ok && !mesh->rig && has_draco(&g) && !decode_draco_is_ready();
    ok = ok && !*needs_other && gltf_open_buffers(&g) && gltf_find_nodes(&g);
    if (ok && mesh->rig)
        ok = gltf_rig(&g, result);
    else if (ok)
        ok = mesh->moving ? gltf_moving(&g, result) : make_surface(&g, result);
    if (ok && !mesh->rig)
        result->morph_target_count = count_targets(&g);
    finish(&g);
    return ok;
}
