/* Fuzzes the readers of meshes of kiln-decode, the separate process that decodes strangers' files:
 * any bytes must give a mesh within the limits or an error. If this fails, a malicious mesh may
 * take over kiln-decode. Here the readers run in the fuzzer's process, so that libFuzzer sees the
 * code that an input reaches; Draco's library is not there, and the target `mesh` tests kiln with
 * it, in the process that has it. */
#include <stdlib.h>

#include "decode.h"
#include "fuzz.h"
#include "image_check.h"
#include "mesh_format.h"

/* Returns an empty result. One is used for all inputs, since its arrays are large. */
static struct kiln_mesh_result *empty_result(void)
{
    static struct kiln_mesh_result *result;
    if (!result) {
        decode_mesh_begin();
        result = calloc(1, sizeof *result);
    }
    require(result != NULL, "no memory");
    struct kiln_skin_result *skin = &result->skin;
    free(skin->deltas);
    skin->deltas = NULL;
    result->vertex_count = result->triangle_count = 0;
    skin->node_count = skin->bone_count = skin->clip_count = skin->channel_count = 0;
    skin->key_count = skin->morph_count = skin->morph_channel_count = skin->delta_count = 0;
    struct kiln_looks_result *looks = &result->looks;
    free(looks->bytes);
    looks->bytes = NULL;
    looks->material_count = looks->texture_count = looks->byte_count = 0;
    looks->has_uvs = looks->has_second_uvs = looks->has_colors = false;
    result->notes[0] = '\0';
    return result;
}

/* Gives an OBJ its own text as that of every file of materials that it names. */
static unsigned char *open_itself(void *user, enum kiln_companion kind, const char *name,
                                  size_t *size)
{
    const struct decode_mesh *mesh = user;
    unsigned char *bytes =
        kind == KILN_COMPANION_MATERIALS && *name ? malloc(mesh->size + 1) : NULL;
    if (bytes)
        memcpy(bytes, mesh->bytes, mesh->size);
    *size = mesh->size;
    return bytes;
}

enum way { PLAIN, WITH_UVS, WITH_MATERIALS, MOVING };

static void import(const uint8_t *data, size_t size, enum kiln_mesh_format format, enum way way)
{
    struct kiln_error error = {0};
    struct decode_mesh mesh = {.format = format,
                               .uvs = way == WITH_UVS,
                               .materials = way == WITH_MATERIALS,
                               .moving = way == MOVING,
                               .bytes = data,
                               .size = size,
                               .open = open_itself};
    mesh.user = &mesh;
    struct kiln_mesh_result *result = empty_result();
    bool needs_other = false;
    const bool made = decode_mesh(&mesh, result, &needs_other, &error);
    fuzz_taken = fuzz_taken || made || needs_other;
    require(made || needs_other || (error.code != KILN_OK && *error.message),
            "an error without a message");
    require(result->vertex_count <= KILN_MAX_MESH_VERTICES &&
                result->triangle_count <= KILN_MAX_MESH_TRIANGLES &&
                result->skin.node_count <= KILN_MAX_SKIN_NODES &&
                result->skin.bone_count <= KILN_MAX_SKIN_BONES &&
                result->skin.clip_count <= KILN_MAX_CLIPS &&
                result->skin.channel_count <= KILN_MAX_CLIP_CHANNELS &&
                result->skin.key_count <= KILN_MAX_CLIP_KEYS &&
                result->skin.morph_count <= KILN_MAX_SKIN_MORPHS &&
                result->skin.morph_channel_count <= KILN_MAX_CLIP_MORPHS &&
                result->skin.delta_count <= KILN_MAX_SKIN_DELTAS &&
                result->looks.material_count <= KILN_MAX_MATERIALS &&
                result->looks.texture_count <= KILN_MAX_TEXTURES &&
                result->looks.byte_count <= KILN_MAX_TEXTURE_BYTES,
            "a mesh beyond the limits");
    if (made && mesh.materials) { /* what kiln takes of it has all numbers within their ranges */
        struct kiln_mesh_looks *looks = kiln_looks_take("fuzz", result, &error);
        require(looks != NULL, error.message);
        kiln_mesh_looks_destroy(&looks);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_taken = false;
    const enum kiln_mesh_format format = guess_format(data, size);
    import(data, size, format, PLAIN);
    import(data, size, format, WITH_UVS);
    import(data, size, format, WITH_MATERIALS);
    if (format == KILN_MESH_GLTF || format == KILN_MESH_GLB)
        import(data, size, format, MOVING);
    return 0;
}
