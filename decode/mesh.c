/* This file finds the reader of a mesh by its format, and turns what it finds into kiln's arrays.
 *
 * It is a part of the process kiln-decode, which is confined before a mesh is read, since a mesh
 * may be malicious. So decode_mesh must not open a file or a library: another file comes only
 * through mesh->open, which asks kiln for it. */
#include <string.h>

#include "base/error.h"
#include "decode.h"
#include "model.h"

/* ---- glTF ------------------------------------------------------------------------------------ */

static const char *const extensions[] = {[KILN_MESH_GLTF] = ".gltf", [KILN_MESH_GLB] = ".glb"};

/* Checks that the contents of a glTF file begin as those of its form do. */
static bool check_contents(const struct decode_mesh *mesh, struct kiln_error *error)
{
    const unsigned char *bytes = mesh->bytes;
    size_t start = 0;
    bool good = false;
    if (mesh->format == KILN_MESH_GLB) {
        good = mesh->size >= 4 && memcmp(bytes, "glTF", 4) == 0;
    } else {
        if (mesh->size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0)
            start = 3; /* a byte order mark */
        while (start < mesh->size && bytes[start] && strchr(" \t\r\n", bytes[start]))
            start++;
        good = start < mesh->size && bytes[start] == '{';
    }
    return good || kiln_error_set(error, KILN_INVALID_INPUT,
                                  "the contents of the file are not those of a %s file",
                                  extensions[mesh->format]);
}

/* ---- the mesh -------------------------------------------------------------------------------- */

bool decode_refuse_size(struct kiln_error *error)
{
    return kiln_error_set(error, KILN_INVALID_INPUT,
                          "the mesh is too large; allowed are %d vertices and %d triangles",
                          KILN_MAX_MESH_VERTICES, KILN_MAX_MESH_TRIANGLES);
}

typedef bool read_model(const struct decode_mesh *wanted, struct decode_model *model,
                        struct kiln_error *error);

/* The readers of formats in which nothing moves. */
static read_model *const readers[] = {
    [KILN_MESH_OBJ] = decode_obj, [KILN_MESH_PLY] = decode_ply, [KILN_MESH_STL] = decode_stl};

static bool read_still(const struct decode_mesh *mesh, struct kiln_mesh_result *result,
                       struct kiln_error *error)
{
    struct decode_model model = {.looks = mesh->materials ? &result->looks : NULL,
                                 .notes = result->notes};
    if (mesh->rig)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "the file has no nodes; allowed are glTF and GLB files");
    if (mesh->moving)
        return kiln_error_set(error, KILN_INVALID_INPUT, "the file has no animation");
    const bool ok =
        readers[mesh->format](mesh, &model, error) && decode_surface(mesh, &model, result, error);
    decode_model_finish(&model);
    return ok;
}

bool decode_mesh(const struct decode_mesh *mesh, struct kiln_mesh_result *result, bool *needs_other,
                 struct kiln_error *error)
{
    const bool is_gltf = mesh->format == KILN_MESH_GLTF || mesh->format == KILN_MESH_GLB;
    *needs_other = false;
    if (mesh->size == 0)
        return kiln_error_set(error, KILN_INVALID_INPUT, "the mesh file is empty");
    if (!(is_gltf ? check_contents(mesh, error) && decode_gltf(mesh, result, needs_other, error)
                  : read_still(mesh, result, error)))
        return false;
    if (mesh->rig)
        return true;
    const char *lacks = result->triangle_count == 0 ? "no triangles"
                        : result->vertex_count < 3  ? "no triangle with an area"
                                                    : NULL;
    return !lacks || kiln_error_set(error, KILN_INVALID_INPUT, "the mesh has %s", lacks);
}
