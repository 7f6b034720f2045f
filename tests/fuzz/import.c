/* Fuzzes the readers of meshes of kiln-decode, the separate process that decodes strangers' files,
 * and how it converts the scenes that the library assimp imports: any bytes must give a mesh within
 * the limits or an error. If this fails, a malicious mesh may take over kiln-decode through kiln's
 * own code. Here assimp runs in the fuzzer's process, so that libFuzzer sees the code that an input
 * reaches. A crash inside assimp is not a fault of kiln, which runs assimp only in kiln-decode; the
 * target `mesh` tests kiln with that process. */
#include <stdlib.h>

#include "decode.h"
#include "fuzz.h"
#include "image_check.h"
#include "mesh_format.h"

static void import(const uint8_t *data, size_t size, enum kiln_mesh_format format, bool moving)
{
    struct kiln_error error = {0};
    const struct decode_mesh mesh = {
        .format = format, .uvs = !moving, .moving = moving, .bytes = data, .size = size};
    struct kiln_mesh_result *result = calloc(1, sizeof *result);
    require(result != NULL, "no memory");
    const bool made = decode_mesh(&mesh, result, &error);
    require(made || (error.code != KILN_OK && *error.message), "an error without a message");
    require(result->vertex_count <= KILN_MAX_MESH_VERTICES &&
                result->triangle_count <= KILN_MAX_MESH_TRIANGLES &&
                result->skin.node_count <= KILN_MAX_SKIN_NODES &&
                result->skin.bone_count <= KILN_MAX_SKIN_BONES &&
                result->skin.clip_count <= KILN_MAX_CLIPS &&
                result->skin.channel_count <= KILN_MAX_CLIP_CHANNELS &&
                result->skin.key_count <= KILN_MAX_CLIP_KEYS,
            "a mesh beyond the limits");
    free(result);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct kiln_error error = {0};
    require(decode_mesh_begin(&error), "assimp is missing");
    const enum kiln_mesh_format format = guess_format(data, size);
    import(data, size, format, false);
    if (format == KILN_MESH_GLTF || format == KILN_MESH_GLB)
        import(data, size, format, true);
    return 0;
}
