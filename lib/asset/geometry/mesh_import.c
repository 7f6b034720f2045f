/* assimp is loaded here and nowhere else, so that programs without meshes start without it. It
 * reads through callbacks that know the file itself and, for glTF, buffers below the asset root. */
#include "asset/geometry/mesh_import.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/file_in.h"
#include "base/hash.h"

/* The version that the headers describe; any 5.x has this name. */
#define LIBRARY "libassimp.so.5"

static const float CREASE_DEG =
    50.0f; /* smooth normals across flatter edges, where a file has none */

/* ---- the library ----------------------------------------------------------------------------- */

struct assimp {
    struct aiPropertyStore *(*create_properties)(void);
    void (*set_integer)(struct aiPropertyStore *store, const char *name, int value);
    void (*set_float)(struct aiPropertyStore *store, const char *name, ai_real value);
    const struct aiScene *(*import)(const char *file, unsigned flags, struct aiFileIO *io,
                                    const struct aiPropertyStore *properties);
    const char *(*error_string)(void);
};

static void find(void *library, const char *name, void *function)
{
    void *found = dlsym(library, name);
    if (found)
        memcpy(function, &found, sizeof found); /* POSIX: an object pointer holds a function's */
}

static bool load_library(struct assimp *assimp, struct kiln_error *error, const char *name)
{
    void *library = dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        kiln_error_set(error, KILN_IO,
                       "%s: meshes need " LIBRARY
                       ", which is not installed (Debian's package libassimp5)",
                       name);
        return false;
    }
    find(library, "aiCreatePropertyStore", &assimp->create_properties);
    find(library, "aiSetImportPropertyInteger", &assimp->set_integer);
    find(library, "aiSetImportPropertyFloat", &assimp->set_float);
    find(library, "aiImportFileExWithProperties", &assimp->import);
    find(library, "aiGetErrorString", &assimp->error_string);
    if (assimp->create_properties && assimp->set_integer && assimp->set_float && assimp->import &&
        assimp->error_string)
        return true;
    kiln_error_set(error, KILN_IO, "%s: " LIBRARY " is not the one that kiln knows", name);
    return false;
}

/* ---- files ----------------------------------------------------------------------------------- */

enum { MAX_FILES = 64 };

struct files {
    const struct kiln_mesh_request *request;
    const char *main_name;
    struct kiln_error refusal;       /* of the first file that may not be opened, if any */
    char hashes[MAX_FILES * 64 + 1]; /* of the file and its buffers, in the order of opening */
    size_t hash_length;
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
    /* From the end, assimp counts backwards or forwards, by importer: both are 0 in use. */
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

static bool note_contents(struct files *files, const void *bytes, size_t size)
{
    char hex[65];
    if (files->hash_length + 64 >= sizeof files->hashes)
        return false;
    kiln_hash_sha256(bytes, size, hex);
    memcpy(files->hashes + files->hash_length, hex, sizeof hex);
    files->hash_length += 64;
    return true;
}

/* A path of plain steps downwards, by its text. */
static bool stays_below(const char *path)
{
    if (path[0] == '/' || strchr(path, ':') || strchr(path, '\\'))
        return false;
    for (const char *part = path; *part;) {
        size_t length = strcspn(part, "/");
        if (length == 2 && part[0] == '.' && part[1] == '.')
            return false;
        part += length + (part[length] == '/');
    }
    return true;
}

/* The buffer's bytes, for the caller to free. */
static unsigned char *read_buffer(struct files *files, const char *name, size_t *size)
{
    const struct kiln_mesh_request *request = files->request;
    char path[KILN_PATH_SIZE];
    if (!request->folder || !stays_below(name)) {
        kiln_error_set(&files->refusal, KILN_INVALID_INPUT, "%s: it names the file '%.200s'; %s",
                       request->name, name,
                       request->folder ? "its files must lie in its folder or below"
                                       : "it may name no other files");
        return NULL;
    }
    int length = snprintf(path, sizeof path, "%s/%s", request->folder, name);
    char *real = length > 0 && (size_t)length < sizeof path ? realpath(path, NULL) : NULL;
    unsigned char *bytes = NULL;
    if (!real)
        kiln_error_set(&files->refusal, KILN_INVALID_INPUT,
                       "%s: it names the file '%.200s', which "
                       "does not exist",
                       request->name, name);
    else if (!kiln_path_below(real, request->root))
        kiln_error_set(&files->refusal, KILN_INVALID_INPUT,
                       "%s: it names the file '%.200s', which "
                       "leads outside the asset root",
                       request->name, name);
    else
        bytes = kiln_file_read(real, "buffer", "glTF buffer", KILN_MAX_MESH_BYTES, size,
                               &files->refusal);
    free(real);
    return bytes;
}

static struct aiFile *on_open(struct aiFileIO *io, const char *name, const char *mode)
{
    struct files *files = (struct files *)io->UserData;
    const struct kiln_mesh_request *request = files->request;
    if (mode[0] != 'r' || files->refusal.code != KILN_OK)
        return NULL;
    if (strcmp(name, files->main_name) == 0)
        return open_bytes(request->bytes, request->size, NULL);
    if (strcmp(request->extension, ".gltf") != 0)
        return NULL; /* an OBJ's materials: they are left out */
    size_t size = 0;
    unsigned char *bytes = read_buffer(files, name, &size);
    if (!bytes || !note_contents(files, bytes, size)) {
        free(bytes);
        return NULL;
    }
    return open_bytes(bytes, size, bytes);
}

/* ---- the mesh -------------------------------------------------------------------------------- */

static bool refuse_size(const struct kiln_mesh_request *request, struct kiln_error *error)
{
    return kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: the mesh is too large; allowed are %d vertices and %d triangles",
                          request->name, KILN_MAX_MESH_VERTICES, KILN_MAX_MESH_TRIANGLES);
}

static void put_vertex(const struct aiMesh *mesh, unsigned i, float out[6])
{
    const struct aiVector3D *p = &mesh->mVertices[i];
    struct aiVector3D n = mesh->mNormals ? mesh->mNormals[i] : (struct aiVector3D){0, 1, 0};
    float length = sqrtf(n.x * n.x + n.y * n.y + n.z * n.z);
    if (!(length > 1e-12f && length < 1e12f)) /* of a triangle without an area */
        n = (struct aiVector3D){0, length = 1, 0};
    const float vertex[6] = {p->x, p->y, p->z, n.x / length, n.y / length, n.z / length};
    memcpy(out, vertex, sizeof vertex);
}

bool kiln_mesh_import_part(const struct kiln_mesh_request *request, const struct aiMesh *mesh,
                           struct kiln_mesh_result *result)
{
    uint32_t first = result->vertex_count;
    if (mesh->mNumVertices > KILN_MAX_MESH_VERTICES - first)
        return refuse_size(request, &result->error);
    const struct aiVector3D *uvs = mesh->mTextureCoords[0];
    if (request->uvs && !uvs)
        return kiln_error_set(&result->error, KILN_INVALID_INPUT,
                              "%s: the mesh, or a part of it, has no texture coordinates, by which "
                              "paint would find its places",
                              request->name);
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        put_vertex(mesh, i, result->vertices[first + i]);
        if (request->uvs) {
            result->uvs[first + i][0] = uvs[i].x;
            result->uvs[first + i][1] = uvs[i].y;
        }
    }
    result->vertex_count += mesh->mNumVertices;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices != 3)
            continue;
        if (result->triangle_count == KILN_MAX_MESH_TRIANGLES)
            return refuse_size(request, &result->error);
        uint32_t *triangle = result->triangles[result->triangle_count++];
        for (int c = 0; c < 3; c++)
            triangle[c] = first + face->mIndices[c];
    }
    return true;
}

static bool put_scene(const struct kiln_mesh_request *request, const struct aiScene *scene,
                      struct kiln_mesh_result *result)
{
    if (request->moving && !kiln_skin_import(request, scene, result))
        return false;
    for (unsigned i = 0; !request->moving && i < scene->mNumMeshes; i++) {
        if (!kiln_mesh_import_part(request, scene->mMeshes[i], result))
            return false;
    }
    const char *lacks = result->triangle_count == 0 ? "no triangles"
                        : result->vertex_count < 3  ? "no triangle with an area"
                                                    : NULL;
    return !lacks || kiln_error_set(&result->error, KILN_INVALID_INPUT, "%s: the mesh has %s",
                                    request->name, lacks);
}

static struct aiPropertyStore *make_properties(const struct assimp *assimp,
                                               const struct kiln_mesh_request *request)
{
    struct aiPropertyStore *properties = assimp->create_properties();
    if (properties) {
        const int still =
            request->moving ? 0 : (int)aiComponent_BONEWEIGHTS | (int)aiComponent_ANIMATIONS;
        const int plain = request->uvs ? 0 : (int)aiComponent_TEXCOORDS;
        assimp->set_integer(properties, AI_CONFIG_PP_RVC_FLAGS,
                            still | plain | (int)aiComponent_TANGENTS_AND_BITANGENTS |
                                (int)aiComponent_COLORS | (int)aiComponent_TEXTURES |
                                (int)aiComponent_LIGHTS | (int)aiComponent_CAMERAS);
        assimp->set_integer(properties, AI_CONFIG_PP_SBP_REMOVE,
                            aiPrimitiveType_POINT | aiPrimitiveType_LINE);
        assimp->set_float(properties, AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, CREASE_DEG);
    }
    return properties;
}

void kiln_mesh_import(const struct kiln_mesh_request *request, struct kiln_mesh_result *result)
{
    struct assimp assimp = {0};
    char main_name[16];
    snprintf(main_name, sizeof main_name, "mesh%s", request->extension);
    struct files files = {.request = request, .main_name = main_name};
    struct aiFileIO io = {
        .OpenProc = on_open, .CloseProc = on_close, .UserData = (aiUserData)&files};
    if (!load_library(&assimp, &result->error, request->name))
        return;
    struct aiPropertyStore *properties = make_properties(&assimp, request);
    if (!properties || !note_contents(&files, request->bytes, request->size)) {
        kiln_error_set(&result->error, KILN_DEVICE_FAILED,
                       "%s: out of memory while reading the mesh", request->name);
        return;
    }
    const unsigned flags = aiProcess_ValidateDataStructure | aiProcess_RemoveComponent |
                           aiProcess_Triangulate | aiProcess_SortByPType;
    /* In one piece; what moves stays as it is, since its pieces do not move alike. */
    const unsigned still = aiProcess_PreTransformVertices | aiProcess_GenSmoothNormals |
                           aiProcess_JoinIdenticalVertices;
    const struct aiScene *scene =
        assimp.import(main_name, request->moving ? flags : flags | still, &io, properties);
    /* A file that may not be opened is no reason for assimp to give up: it looks for others. */
    if (files.refusal.code != KILN_OK)
        result->error = files.refusal;
    else if (scene)
        result->ok = put_scene(request, scene, result);
    else
        kiln_error_set(&result->error, KILN_INVALID_INPUT, "%s: the mesh is broken: %.300s",
                       request->name, assimp.error_string());
    if (result->ok)
        kiln_hash_sha256(files.hashes, files.hash_length, result->hash);
}
