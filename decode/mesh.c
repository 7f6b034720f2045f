/* This file finds the reader of a mesh by its format. glTF is imported by assimp, which is opened
 * here and nowhere else. Assimp reads through callbacks, which serve the file itself and the
 * buffers that kiln opens.
 *
 * It is a part of the process kiln-decode. main.c calls decode_mesh_begin once and then confines
 * the process, since a mesh may be malicious. After that it calls decode_mesh for each mesh that
 * kiln sends. So decode_mesh must not open a file or a library: another file comes only through
 * mesh->open, which asks kiln for it. assimp_model.c and skin.c take what they need from
 * assimp's scene, and surface.c turns a model into kiln's arrays.
 *
 * The checks before the import find files for which assimp would take too much time or memory, or
 * would give no message that helps. They must stay before the import. */
#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/library.h"
#include "decode.h"
#include "model.h"

/* The library of the version that the included headers describe. Every version 5.x has this name.
 */
#define LIBRARY "libassimp.so.5"

/* ---- the library ----------------------------------------------------------------------------- */

#define FUNCTIONS(F)                                                                               \
    F(aiCreatePropertyStore)                                                                       \
    F(aiReleasePropertyStore)                                                                      \
    F(aiSetImportPropertyInteger)                                                                  \
    F(aiImportFileExWithProperties)                                                                \
    F(aiReleaseImport)                                                                             \
    F(aiGetErrorString)

/* Assimp's functions. decode_mesh_begin finds them, before a file is read. */
static struct {
    FUNCTIONS(KILN_LIBRARY_POINTER)
} ai;

bool decode_mesh_begin(struct kiln_error *error)
{
#define FIND(function) {#function, &ai.function},
    static const struct kiln_library_function functions[] = {FUNCTIONS(FIND)};
    return kiln_library_open(LIBRARY, "libassimp5", functions, sizeof functions / sizeof *functions,
                             error);
}

/* ---- checks of the contents ------------------------------------------------------------------ */

enum { GLB_HEADER = 12, CHUNK_HEADER = 8 };

/* Returns the JSON text of a glTF or GLB file. GLB chunks are padded with spaces, or by some
 * programs with zeros. */
const char *decode_mesh_json(const struct decode_mesh *mesh, size_t *size)
{
    const unsigned char *bytes = mesh->bytes;
    const size_t start = mesh->format == KILN_MESH_GLB ? GLB_HEADER + CHUNK_HEADER : 0;
    *size = mesh->size - start;
    if (start > 0) {
        const unsigned char *b = bytes + GLB_HEADER; /* header of the first chunk: length, type */
        const size_t length = b[0] | (size_t)b[1] << 8 | (size_t)b[2] << 16 | (size_t)b[3] << 24;
        *size = length < *size ? length : *size;
    }
    while (*size > 0 && bytes[start + *size - 1] == '\0')
        --*size;
    return (const char *)bytes + start;
}

/* Checks how deep the JSON of a glTF file is nested. Assimp copies what is nested in "extras" twice
 * for each level, so the time doubles with each level, and an import of 64 levels never ends. */
static bool check_depth(const struct decode_mesh *mesh, struct kiln_error *error)
{
    enum { MOST = 20 };
    size_t size, depth = 0, deepest = 0;
    const char *json = decode_mesh_json(mesh, &size);
    bool quoted = false;
    for (size_t i = 0; i < size; i++) {
        if (quoted && json[i] == '\\')
            i++;
        else if (json[i] == '"')
            quoted = !quoted;
        else if (!quoted && (json[i] == '{' || json[i] == '['))
            depth++;
        else if (!quoted && (json[i] == '}' || json[i] == ']') && depth > 0)
            depth--;
        deepest = depth > deepest ? depth : deepest;
    }
    return deepest <= MOST ||
           kiln_error_set(error, KILN_INVALID_INPUT,
                          "the JSON is nested %zu levels deep; at most %d are allowed", deepest,
                          MOST);
}

static const char *const extensions[] = {[KILN_MESH_GLTF] = ".gltf", [KILN_MESH_GLB] = ".glb"};

/* Checks that the contents of a glTF file begin as those of its form do. */
static bool check_contents(const struct decode_mesh *mesh, struct kiln_error *error)
{
    const unsigned char *bytes = mesh->bytes;
    size_t start = 0;
    bool good = false;
    if (mesh->format == KILN_MESH_GLB) {
        good = mesh->size >= GLB_HEADER + CHUNK_HEADER && memcmp(bytes, "glTF", 4) == 0;
    } else {
        while (start < mesh->size && bytes[start] && strchr(" \t\r\n", bytes[start]))
            start++;
        good = start < mesh->size && bytes[start] == '{';
    }
    if (!good)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "the contents of the file are not those of a %s file",
                              extensions[mesh->format]);
    return check_depth(mesh, error);
}

/* ---- files ----------------------------------------------------------------------------------- */

struct files {
    const struct decode_mesh *mesh;
    const char *main_name;
};

struct reading {
    const unsigned char *bytes;
    size_t size, at;
    unsigned char *owned;
};

static size_t on_read(struct aiFile *file, char *out, size_t size, size_t count)
{
    struct reading *reading = (struct reading *)file->UserData;
    size_t left = reading->size - reading->at;
    size_t taken = size ? left / size : 0;
    taken = taken < count ? taken : count;
    memcpy(out, reading->bytes + reading->at, taken * size);
    reading->at += taken * size;
    return taken;
}

static size_t on_write(struct aiFile *file, const char *bytes, size_t size, size_t count)
{
    (void)file;
    (void)bytes;
    (void)size;
    (void)count;
    return 0;
}

static size_t on_tell(struct aiFile *file)
{
    return ((struct reading *)file->UserData)->at;
}

static size_t on_size(struct aiFile *file)
{
    return ((struct reading *)file->UserData)->size;
}

static enum aiReturn on_seek(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    struct reading *reading = (struct reading *)file->UserData;
    size_t base = origin == aiOrigin_CUR ? reading->at : origin == aiOrigin_END ? reading->size : 0;
    /* Some importers count the offset from the end backwards, others forwards. All of them use only
     * an offset of 0 from the end, so the direction does not matter. */
    size_t at = base + offset;
    if (at > reading->size)
        return aiReturn_FAILURE;
    reading->at = at;
    return aiReturn_SUCCESS;
}

static void on_flush(struct aiFile *file)
{
    (void)file;
}

static void on_close(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    free(((struct reading *)file->UserData)->owned);
    free(file->UserData);
    free(file);
}

static struct aiFile *open_bytes(const void *bytes, size_t size, unsigned char *owned)
{
    struct aiFile *file = calloc(1, sizeof *file);
    struct reading *reading = calloc(1, sizeof *reading);
    if (!file || !reading) {
        free(file);
        free(reading);
        free(owned);
        return NULL;
    }
    *reading = (struct reading){.bytes = bytes, .size = size, .owned = owned};
    *file = (struct aiFile){.ReadProc = on_read,
                            .WriteProc = on_write,
                            .TellProc = on_tell,
                            .FileSizeProc = on_size,
                            .SeekProc = on_seek,
                            .FlushProc = on_flush,
                            .UserData = (aiUserData)reading};
    return file;
}

/* Opens a file for assimp: the mesh under its made-up name, or a buffer of a glTF through kiln. */
static struct aiFile *on_open(struct aiFileIO *io, const char *name, const char *mode)
{
    const struct files *files = (const struct files *)io->UserData;
    const struct decode_mesh *mesh = files->mesh;
    if (mode[0] != 'r')
        return NULL;
    if (strcmp(name, files->main_name) == 0)
        return open_bytes(mesh->bytes, mesh->size, NULL);
    if (mesh->format != KILN_MESH_GLTF || !mesh->open)
        return NULL;
    size_t size = 0;
    unsigned char *bytes = mesh->open(mesh->user, name, &size);
    return bytes ? open_bytes(bytes, size, bytes) : NULL;
}

/* ---- the import ------------------------------------------------------------------------------ */

/* Makes a surface of assimp's scene. The scene is released before the surface takes memory. */
static bool put_surface(const struct decode_mesh *wanted, const struct aiScene **scene,
                        struct kiln_mesh_result *result, struct kiln_error *error)
{
    struct decode_model model = {0};
    bool ok = decode_assimp_model(*scene, &model, error);
    ai.aiReleaseImport(*scene);
    *scene = NULL;
    ok = ok && decode_surface(wanted, &model, result, error);
    decode_model_finish(&model);
    return ok;
}

/* Tells assimp which components of the file to drop, because kiln does not use them. */
static struct aiPropertyStore *make_properties(const struct decode_mesh *wanted)
{
    struct aiPropertyStore *properties = ai.aiCreatePropertyStore();
    if (properties) {
        const int still =
            wanted->moving ? 0 : (int)aiComponent_BONEWEIGHTS | (int)aiComponent_ANIMATIONS;
        const int plain = wanted->uvs ? 0 : (int)aiComponent_TEXCOORDS;
        ai.aiSetImportPropertyInteger(properties, AI_CONFIG_PP_RVC_FLAGS,
                                      still | plain | (int)aiComponent_TANGENTS_AND_BITANGENTS |
                                          (int)aiComponent_COLORS | (int)aiComponent_TEXTURES |
                                          (int)aiComponent_LIGHTS | (int)aiComponent_CAMERAS);
        ai.aiSetImportPropertyInteger(properties, AI_CONFIG_PP_SBP_REMOVE,
                                      aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    }
    return properties;
}

/* Turns assimp's message into one that the author of the file understands. */
static bool explain(const char *said, struct kiln_error *error)
{
    if (strstr(said, "bad_alloc"))
        return decode_out_of_memory(error);
    if (strstr(said, "No meshes remaining"))
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "the mesh has no triangles, only points or lines");
    if (strstr(said, "no faces"))
        return kiln_error_set(error, KILN_INVALID_INPUT, "the mesh has no triangles");
    if (strstr(said, "No suitable reader"))
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "the mesh is broken, or of a version of glTF that cannot be read; "
                              "allowed are 2, and 1 as .gltf");
    return kiln_error_set(error, KILN_INVALID_INPUT, "the mesh is broken: %.300s", said);
}

/* Imports a glTF file by assimp. */
static bool import(const struct decode_mesh *mesh, struct kiln_mesh_result *result,
                   struct kiln_error *error)
{
    char main_name[16];
    if (!check_contents(mesh, error))
        return false;
    snprintf(main_name, sizeof main_name, "mesh%s", extensions[mesh->format]);
    const struct files files = {.mesh = mesh, .main_name = main_name};
    struct aiFileIO io = {
        .OpenProc = on_open, .CloseProc = on_close, .UserData = (aiUserData)&files};
    struct aiPropertyStore *properties = make_properties(mesh);
    if (!properties)
        return decode_out_of_memory(error);
    const unsigned flags = aiProcess_ValidateDataStructure | aiProcess_RemoveComponent |
                           aiProcess_Triangulate | aiProcess_SortByPType;
    const struct aiScene *scene =
        ai.aiImportFileExWithProperties(main_name, flags, &io, properties);
    const bool ok = !scene         ? explain(ai.aiGetErrorString(), error)
                    : mesh->moving ? decode_skin(mesh, scene, result, error)
                                   : put_surface(mesh, &scene, result, error);
    if (scene)
        ai.aiReleaseImport(scene);
    ai.aiReleasePropertyStore(properties);
    return ok;
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
    struct decode_model model = {0};
    if (mesh->moving)
        return kiln_error_set(error, KILN_INVALID_INPUT, "the file has no animation");
    const bool ok =
        readers[mesh->format](mesh, &model, error) && decode_surface(mesh, &model, result, error);
    decode_model_finish(&model);
    return ok;
}

bool decode_mesh(const struct decode_mesh *mesh, struct kiln_mesh_result *result,
                 struct kiln_error *error)
{
    const bool is_gltf = mesh->format == KILN_MESH_GLTF || mesh->format == KILN_MESH_GLB;
    if (mesh->size == 0)
        return kiln_error_set(error, KILN_INVALID_INPUT, "the mesh file is empty");
    if (!(is_gltf ? import(mesh, result, error) : read_still(mesh, result, error)))
        return false;
    const char *lacks = result->triangle_count == 0 ? "no triangles"
                        : result->vertex_count < 3  ? "no triangle with an area"
                                                    : NULL;
    return !lacks || kiln_error_set(error, KILN_INVALID_INPUT, "the mesh has %s", lacks);
}
