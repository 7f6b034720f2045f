/* This file imports meshes through a process of kiln-decode: it opens the files that the process
 * asks for, takes the arrays that it sends, and checks their contents. Each mesh has a process of
 * its own. */
#include "asset/geometry/mesh_in.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "asset/loader/loader.h"
#include "base/error.h"
#include "base/file_in.h"
#include "base/hash.h"

#define ALLOWED "OBJ, glTF, GLB, PLY or STL"

enum {
    MAX_FILES = 64,
    MAX_WISHES = 100, /* of files without which the mesh is not read */
    MAX_MATERIAL_WISHES = 16,
    MAX_MATERIAL_BYTES = 16 << 20,
    MAX_TEXTURE_FILE_BYTES = 1 << 30,
    MOST_TEXTURE_NOTES = 4, /* missing textures that are named */
};

static const float MAX_COORDINATE = 1e6f;

struct request {
    struct kiln_loader *loader; /* may be NULL */
    /* name of the file for messages; paths in the file start at its folder */
    const char *name;
    bool alone; /* true: the file may name no other files */
    struct kiln_decode_request wanted;
    struct kiln_helper *helper;
    struct kiln_error refusal; /* error of the first file that may not be opened, if any */
    struct kiln_error start;   /* error of a process that could not be started, if any */
    /* what kiln has to say of files that a mesh is read without: a line each */
    char notes[KILN_MESSAGE_SIZE];
    /* hashes of the file and of those that it names, in that order */
    char hashes[MAX_FILES * 64 + 1];
    size_t hash_length;
};

/* ---- files ----------------------------------------------------------------------------------- */

static bool note_contents(struct request *request, int file, struct kiln_error *error)
{
    char hex[65];
    if (request->hash_length + 64 >= sizeof request->hashes)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the mesh file names more than %d files; no more are allowed",
                              request->name, MAX_FILES - 1);
    if (!kiln_hash_sha256_descriptor(file, hex))
        return kiln_error_set(error, KILN_IO, "%s: the mesh cannot be read", request->name);
    memcpy(request->hashes + request->hash_length, hex, sizeof hex);
    request->hash_length += 64;
    return true;
}

/* Opens a file that the mesh file names. `file` says what it is, but for its path. The error is
 * what follows the name of the mesh file in a message. Returns the descriptor or -1. */
static int open_companion(const struct request *request, const char *name,
                          struct kiln_loader_file file, struct kiln_error *error)
{
    const char *slash = strrchr(request->name, '/');
    const int folder = slash ? (int)(slash - request->name) + 1 : 0;
    char path[KILN_PATH_SIZE];
    if (request->alone || !kiln_path_stays_below(name)) {
        kiln_error_set(error, KILN_INVALID_INPUT, "the mesh file names the file '%.200s'; %s", name,
                       request->alone ? "a file of this name must not name other files"
                                      : "its files must lie in its folder or below");
        return -1;
    }
    if (snprintf(path, sizeof path, "%.*s%s", folder, request->name, name) >= (int)sizeof path) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "the mesh file names a file whose path is too long");
        return -1;
    }
    file.path = path;
    struct kiln_error reason = {0};
    size_t size = 0;
    int opened = kiln_loader_open(request->loader, &file, &size, &reason);
    if (opened < 0) {
        /* the reason alone: the message begins with the path, which `name` replaces */
        const char *said = strstr(reason.message, ": ");
        kiln_error_set(error, reason.code == KILN_IO ? KILN_INVALID_INPUT : reason.code,
                       "the mesh file names the file '%.200s'%s", name, said ? said : "");
    }
    return opened;
}

/* Opens a buffer of a glTF file, whose contents are a part of the mesh. */
static int open_buffer(struct request *request, const char *name, struct kiln_error *error)
{
    const struct kiln_loader_file file = {NULL, "buffer", "glTF buffer", KILN_MAX_MESH_BYTES};
    struct kiln_error reason = {0};
    int opened = open_companion(request, name, file, &reason);
    if (opened < 0)
        kiln_error_set(error, reason.code, "%s: %.900s", request->name, reason.message);
    if (opened >= 0 && !note_contents(request, opened, error)) {
        close(opened);
        opened = -1;
    }
    return opened;
}

/* Adds lines to notes, as far as there is room for them. */
static void add_notes(char notes[KILN_MESSAGE_SIZE], const char *lines)
{
    size_t length = strlen(notes);
    if (length > 0 && *lines && length < KILN_MESSAGE_SIZE - 1)
        notes[length++] = '\n';
    for (; *lines && length < KILN_MESSAGE_SIZE - 1; lines++)
        notes[length++] = (char)((unsigned char)*lines >= ' ' || *lines == '\n' ? *lines : ' ');
    notes[length] = '\0';
}

/* Opens a file of materials, without which the mesh is read, too: then a note says why it is not.
 * The file is no part of the mesh's hash. */
static int open_materials(struct request *request, const char *name)
{
    static const struct kiln_loader_file file = {NULL, "materials", "MTL", MAX_MATERIAL_BYTES};
    struct kiln_error reason = {0};
    const int opened =
        request->wanted.materials ? open_companion(request, name, file, &reason) : -1;
    if (opened < 0)
        add_notes(request->notes, reason.message);
    return opened;
}

/* Notes which textures are missing: each is opened, but not read. */
static void find_textures(const struct request *request, struct kiln_mesh *mesh)
{
    struct kiln_mesh_looks *looks = mesh->looks;
    char text[64];
    uint32_t missing = 0;
    static const struct kiln_loader_file file = {NULL, "image", "pictures", MAX_TEXTURE_FILE_BYTES};
    for (uint32_t i = 0; i < looks->texture_count; i++) {
        struct kiln_texture *texture = &looks->textures[i];
        if (!*texture->file)
            continue;
        struct kiln_error reason = {0};
        const int opened = open_companion(request, texture->file, file, &reason);
        texture->is_missing = opened < 0;
        missing += texture->is_missing;
        if (opened >= 0)
            close(opened);
        else if (missing <= MOST_TEXTURE_NOTES)
            add_notes(mesh->notes, reason.message);
    }
    const uint32_t more = missing > MOST_TEXTURE_NOTES ? missing - MOST_TEXTURE_NOTES : 0;
    if (more > 0) {
        snprintf(text, sizeof text, "%u more %s missing", more,
                 more == 1 ? "texture is" : "textures are");
        add_notes(mesh->notes, text);
    }
}

/* Sends the process a file that it asked for, or that it may not be read. */
static bool hand_over(struct request *request, const struct kiln_decode_answer *wish,
                      struct kiln_error *error)
{
    int file = -1;
    if (wish->companion == KILN_COMPANION_MATERIALS)
        file = open_materials(request, wish->text);
    else if (request->refusal.code == KILN_OK)
        file = open_buffer(request, wish->text, &request->refusal);
    const struct kiln_decode_file answer = {.is_open = file >= 0};
    const bool sent = kiln_helper_send(request->helper, &answer, sizeof answer, file, error);
    if (file >= 0)
        close(file);
    return sent;
}

/* ---- the answer ------------------------------------------------------------------------------ */

static bool check_vertex(const float v[6])
{
    float length2 = v[3] * v[3] + v[4] * v[4] + v[5] * v[5];
    for (int c = 0; c < 3; c++) {
        if (!(fabsf(v[c]) <= MAX_COORDINATE))
            return false;
    }
    return fabsf(length2 - 1.0f) < 1e-3f;
}

static bool check(const char *name, const struct kiln_mesh_result *result, struct kiln_error *error)
{
    bool good = true;
    for (uint32_t i = 0; good && i < result->triangle_count; i++) {
        for (int c = 0; c < 3; c++)
            good = good && result->triangles[i][c] < result->vertex_count;
    }
    if (!good)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the mesh is broken: the importer returned inconsistent data",
                              name);
    for (uint32_t i = 0; i < result->vertex_count; i++) {
        if (!check_vertex(result->vertices[i]))
            return kiln_error_set(error, KILN_INVALID_INPUT,
                                  "%s: vertex %u lies at %g %g %g; allowed are numbers within "
                                  "-%g and %g",
                                  name, i, (double)result->vertices[i][0],
                                  (double)result->vertices[i][1], (double)result->vertices[i][2],
                                  (double)MAX_COORDINATE, (double)MAX_COORDINATE);
    }
    return true;
}

static struct kiln_mesh *copy(const struct kiln_mesh_result *result, bool uvs)
{
    struct kiln_mesh *mesh = calloc(1, sizeof *mesh);
    if (!mesh)
        return NULL;
    mesh->vertex_count = result->vertex_count;
    mesh->triangle_count = result->triangle_count;
    mesh->morph_target_count = result->morph_target_count;
    mesh->vertices = malloc(mesh->vertex_count * sizeof *mesh->vertices);
    mesh->triangles = malloc(mesh->triangle_count * sizeof *mesh->triangles);
    if (uvs)
        mesh->uvs = malloc(mesh->vertex_count * sizeof *mesh->uvs);
    if (!mesh->vertices || !mesh->triangles || (uvs && !mesh->uvs)) {
        kiln_mesh_destroy(&mesh);
        return NULL;
    }
    if (uvs)
        memcpy(mesh->uvs, result->uvs, mesh->vertex_count * sizeof *mesh->uvs);
    memcpy(mesh->vertices, result->vertices, mesh->vertex_count * sizeof *mesh->vertices);
    memcpy(mesh->triangles, result->triangles, mesh->triangle_count * sizeof *mesh->triangles);
    kiln_mesh_find_bounds(mesh);
    return mesh;
}

struct receiving {
    const struct request *request;
    struct kiln_error *reason;
};

static bool receive_array(void *user, void *array, size_t bytes)
{
    const struct receiving *receiving = user;
    const struct request *request = receiving->request;
    return kiln_helper_receive(request->helper, kiln_loader_caller(request->loader), array, bytes,
                               receiving->reason);
}

/* Checks the counts of an answer before any array is received. */
static bool are_counts_sound(const struct kiln_mesh_result *result, bool moving, bool rig)
{
    const struct kiln_skin_result *skin = &result->skin;
    if (rig)
        return result->vertex_count == 0 && result->triangle_count == 0 &&
               result->rig.node_count <= KILN_MAX_RIG_NODES && skin->clip_count <= KILN_MAX_CLIPS &&
               skin->channel_count <= KILN_MAX_CLIP_CHANNELS &&
               skin->key_count <= KILN_MAX_CLIP_KEYS;
    const struct kiln_looks_result *looks = &result->looks;
    return result->vertex_count >= 3 && result->vertex_count <= KILN_MAX_MESH_VERTICES &&
           result->triangle_count >= 1 && result->triangle_count <= KILN_MAX_MESH_TRIANGLES &&
           looks->material_count <= KILN_MAX_MATERIALS &&
           looks->texture_count <= KILN_MAX_TEXTURES &&
           looks->byte_count <= KILN_MAX_TEXTURE_BYTES &&
           (!moving ||
            (skin->node_count <= KILN_MAX_SKIN_NODES && skin->bone_count <= KILN_MAX_SKIN_BONES &&
             skin->clip_count <= KILN_MAX_CLIPS && skin->channel_count <= KILN_MAX_CLIP_CHANNELS &&
             skin->key_count <= KILN_MAX_CLIP_KEYS && skin->morph_count <= KILN_MAX_SKIN_MORPHS &&
             skin->morph_channel_count <= KILN_MAX_CLIP_MORPHS &&
             skin->delta_count <= KILN_MAX_SKIN_DELTAS));
}

static void take_counts(const struct kiln_decode_answer *answer, struct kiln_mesh_result *result)
{
    result->vertex_count = answer->vertices;
    result->triangle_count = answer->triangles;
    result->morph_target_count = answer->morph_targets;
    result->skin.node_count = answer->nodes;
    result->skin.bone_count = answer->bones;
    result->skin.clip_count = answer->clips;
    result->skin.channel_count = answer->channels_of_clips;
    result->skin.key_count = answer->keys;
    result->skin.morph_count = answer->morphs;
    result->skin.morph_channel_count = answer->morph_channels;
    result->skin.delta_count = answer->deltas;
    result->rig.node_count = answer->nodes;
    result->looks.material_count = answer->materials;
    result->looks.texture_count = answer->textures;
    result->looks.byte_count = answer->texture_bytes;
    result->looks.has_uvs = answer->has_uvs;
    result->looks.has_second_uvs = answer->has_second_uvs;
    result->looks.has_colors = answer->has_colors;
    snprintf(result->notes, sizeof result->notes, "%s", answer->text);
}

/* Takes memory for the arrays whose largest sizes are too large to have it always. */
static bool allocate_arrays(const struct request *request, struct kiln_mesh_result *result,
                            struct kiln_error *reason)
{
    struct kiln_skin_result *skin = &result->skin;
    struct kiln_looks_result *looks = &result->looks;
    const bool morphs = request->wanted.moving && skin->delta_count > 0;
    const bool textures = request->wanted.materials && looks->byte_count > 0;
    if (morphs)
        skin->deltas = calloc(skin->delta_count, sizeof *skin->deltas);
    if (textures)
        looks->bytes = malloc(looks->byte_count);
    return ((!morphs || skin->deltas) && (!textures || looks->bytes)) ||
           kiln_error_no_memory(reason, "its morph targets or textures");
}

/* Takes the arrays of an answer. */
static bool receive_arrays(struct request *request, struct kiln_mesh_result *result,
                           struct kiln_error *reason)
{
    const bool moving = request->wanted.moving;
    struct receiving receiving = {request, reason};
    if (!are_counts_sound(result, moving, request->wanted.rig))
        return kiln_error_set(reason, KILN_INVALID_INPUT,
                              "the importer returned inconsistent data");
    return allocate_arrays(request, result, reason) &&
           kiln_mesh_visit_arrays(result, &request->wanted, receive_array, &receiving);
}

/* Waits for the answer, and sends the files that the process asks for meanwhile. */
static bool await(struct request *request, unsigned other, struct kiln_decode_answer *answer,
                  struct kiln_error *error)
{
    const unsigned expected = 1u << KILN_DECODE_NEEDS_FILE | 1u << KILN_DECODE_MESH_MADE | other;
    int wishes = 0, material_wishes = 0;
    while (wishes < MAX_WISHES && material_wishes <= MAX_MATERIAL_WISHES) {
        if (!kiln_helper_answer(request->helper, kiln_loader_caller(request->loader), expected,
                                answer, error))
            return false;
        if (answer->what != KILN_DECODE_NEEDS_FILE)
            return true;
        if (!hand_over(request, answer, error))
            return false;
        ++*(answer->companion == KILN_COMPANION_MATERIALS ? &material_wishes : &wishes);
    }
    return kiln_error_set(error, KILN_INVALID_INPUT, "the mesh file names too many files");
}

/* Asks a process of a kind for the mesh in a file, and waits for it. */
static bool ask(struct request *request, enum kiln_decode_kind kind, int file,
                struct kiln_decode_answer *answer, struct kiln_error *reason)
{
    /* A process of the other kind needs no further one. */
    const unsigned other = kind == KILN_DECODE_MESH ? 1u << KILN_DECODE_NEEDS_OTHER : 0;
    kiln_helper_end(&request->helper);
    request->helper = kiln_loader_take(request->loader, kind, &request->start);
    return request->helper &&
           kiln_helper_send(request->helper, &request->wanted, sizeof request->wanted, file,
                            reason) &&
           await(request, other, answer, reason);
}

/* Receives the mesh in a file. */
static bool receive(struct request *request, int file, struct kiln_mesh_result *result,
                    struct kiln_error *error)
{
    struct kiln_decode_answer answer;
    struct kiln_error reason = {0};
    bool ok = ask(request, KILN_DECODE_MESH, file, &answer, &reason);
    if (ok && answer.what == KILN_DECODE_NEEDS_OTHER)
        ok = ask(request, KILN_DECODE_DRACO, file, &answer, &reason);
    if (ok) {
        take_counts(&answer, result);
        ok = receive_arrays(request, result, &reason);
    }
    if (request->refusal.code != KILN_OK)
        return kiln_error_set(error, request->refusal.code, "%s", request->refusal.message);
    if (request->start.code != KILN_OK)
        return kiln_error_set(error, request->start.code, "%s", request->start.message);
    return ok || kiln_helper_fail(request->name, &reason, error);
}

/* Holds what a file is imported as: a mesh, a skin or a rig. */
struct imported {
    struct kiln_mesh *mesh;
    struct kiln_skin *skin; /* of a mesh that moves */
    struct kiln_rig *rig;
};

static struct imported take(struct request *request, const struct kiln_mesh_result *result,
                            struct kiln_error *error)
{
    struct imported imported = {.mesh = NULL};
    if (request->wanted.rig) {
        char hash[65];
        kiln_hash_sha256(request->hashes, request->hash_length, hash);
        imported.rig = kiln_rig_take(request->name, result, hash, error);
        return imported;
    }
    if (!check(request->name, result, error))
        return imported;
    const bool uvs = request->wanted.uvs || (request->wanted.materials && result->looks.has_uvs);
    struct kiln_mesh *mesh = copy(result, uvs);
    if (!mesh) {
        kiln_error_no_memory(error, "reading the mesh of %s", request->name);
        return imported;
    }
    if (request->wanted.materials) {
        mesh->looks = kiln_looks_take(request->name, result, error);
        if (!mesh->looks) {
            kiln_mesh_destroy(&mesh);
            return imported;
        }
    }
    add_notes(mesh->notes, request->notes);
    add_notes(mesh->notes, result->notes);
    if (mesh->looks)
        find_textures(request, mesh);
    kiln_hash_sha256(request->hashes, request->hash_length, mesh->hash);
    if (request->wanted.moving)
        imported.skin = kiln_skin_take(request->name, result, mesh, error);
    else
        imported.mesh = mesh;
    return imported;
}

/* ---- importing ------------------------------------------------------------------------------- */

/* Refuses a format that kiln does not read, with the command by which Blender converts the file.
 * The command names the file only if a shell takes its name as it is. */
static bool refuse_convertible(const char *name, const char *format, const char *import,
                               struct kiln_error *error)
{
    static const char plain[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._-";
    const char *dot = strrchr(name, '.');
    const bool is_plain = name[strspn(name, plain)] == '\0' && name[0] != '-' && strlen(name) < 100;
    const char *stem = is_plain ? name : "FILE";
    const int length = is_plain ? (int)(dot - name) : 4;
    char command[1024], open[512] = "";
    if (import)
        snprintf(open, sizeof open,
                 "bpy.ops.wm.read_factory_settings(use_empty=True); %s(filepath='%.*s%s'); ",
                 import, length, stem, dot);
    snprintf(command, sizeof command,
             "blender -b%s%.*s%s --python-expr \"import bpy; "
             "%sbpy.ops.export_scene.gltf(filepath='%.*s.glb')\"",
             import ? "" : " ", import ? 0 : length, stem, import ? "" : dot, open, length, stem);
    return kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: %s is not read; allowed are " ALLOWED
                          " files. Blender converts it: %s",
                          name, format, command);
}

static bool find_format(struct request *request, struct kiln_error *error)
{
    static const struct {
        const char *extension;
        enum kiln_mesh_format format;
    } formats[] = {{".obj", KILN_MESH_OBJ},
                   {".gltf", KILN_MESH_GLTF},
                   {".glb", KILN_MESH_GLB},
                   {".ply", KILN_MESH_PLY},
                   {".stl", KILN_MESH_STL}};
    static const struct {
        const char *extension, *format, *import; /* import: Blender's; NULL: it opens the file */
    } others[] = {{".fbx", "FBX", "bpy.ops.import_scene.fbx"},
                  {".dae", "COLLADA", "bpy.ops.wm.collada_import"},
                  {".usd", "USD", "bpy.ops.wm.usd_import"},
                  {".usda", "USD", "bpy.ops.wm.usd_import"},
                  {".usdc", "USD", "bpy.ops.wm.usd_import"},
                  {".usdz", "USD", "bpy.ops.wm.usd_import"},
                  {".abc", "Alembic", "bpy.ops.wm.alembic_import"},
                  {".blend", "a file of Blender", NULL}};
    const char *dot = strrchr(request->name, '.');
    for (size_t i = 0; dot && i < sizeof formats / sizeof *formats; i++) {
        if (strcasecmp(dot, formats[i].extension) == 0) {
            request->wanted.format = formats[i].format;
            return true;
        }
    }
    for (size_t i = 0; dot && i < sizeof others / sizeof *others; i++) {
        if (strcasecmp(dot, others[i].extension) == 0)
            return refuse_convertible(request->name, others[i].format, others[i].import, error);
    }
    return kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: the name is not that of a mesh; allowed are " ALLOWED
                          " files (.obj, .gltf, .glb, .ply, .stl)",
                          request->name);
}

static struct imported import(struct request *request, int file, struct kiln_error *error)
{
    struct imported imported = {.mesh = NULL};
    if (!note_contents(request, file, error))
        return imported;
    struct kiln_mesh_result *result = kiln_mesh_result_create(false);
    if (!result)
        kiln_error_no_memory(error, "reading the mesh of %s", request->name);
    request->wanted.most_bytes = KILN_MAX_MESH_BYTES;
    if (result && receive(request, file, result, error))
        imported = take(request, result, error);
    kiln_helper_end(&request->helper);
    kiln_mesh_result_destroy(&result);
    return imported;
}

static struct imported load(struct request *request, struct kiln_error *error)
{
    struct imported imported = {.mesh = NULL};
    const struct kiln_loader_file named = {request->name, "mesh", ALLOWED, KILN_MAX_MESH_BYTES};
    size_t size = 0;
    const int file =
        find_format(request, error) ? kiln_loader_open(request->loader, &named, &size, error) : -1;
    if (file < 0)
        return imported;
    imported = import(request, file, error);
    close(file);
    return imported;
}

static struct imported parse(struct request *request, const void *bytes, size_t size,
                             struct kiln_error *error)
{
    struct imported imported = {.mesh = NULL};
    request->alone = true;
    const bool may_be =
        kiln_file_check_size(request->name, "mesh", size, KILN_MAX_MESH_BYTES, error) &&
        find_format(request, error);
    const int file = may_be ? kiln_loader_file_of(bytes, size, request->name, error) : -1;
    if (file < 0)
        return imported;
    imported = import(request, file, error);
    close(file);
    return imported;
}

struct kiln_mesh *kiln_mesh_parse(const void *bytes, size_t size, const char *name,
                                  struct kiln_error *error)
{
    struct request request = {.name = name};
    return parse(&request, bytes, size, error).mesh;
}

struct kiln_mesh *kiln_mesh_load(struct kiln_loader *loader, const char *path,
                                 struct kiln_error *error)
{
    struct request request = {.loader = loader, .name = path};
    return load(&request, error).mesh;
}

struct kiln_mesh *kiln_mesh_load_unwrapped(struct kiln_loader *loader, const char *path,
                                           struct kiln_error *error)
{
    struct request request = {.loader = loader, .name = path, .wanted = {.uvs = 1}};
    return load(&request, error).mesh;
}

struct kiln_mesh *kiln_mesh_load_with_materials(struct kiln_loader *loader, const char *path,
                                                struct kiln_error *error)
{
    struct request request = {.loader = loader, .name = path, .wanted = {.materials = 1}};
    return load(&request, error).mesh;
}

struct kiln_mesh *kiln_mesh_parse_with_materials(const void *bytes, size_t size, const char *name,
                                                 struct kiln_error *error)
{
    struct request request = {.name = name, .wanted = {.materials = 1}};
    return parse(&request, bytes, size, error).mesh;
}

struct kiln_skin *kiln_skin_parse(const void *bytes, size_t size, const char *name,
                                  struct kiln_error *error)
{
    struct request request = {.name = name, .wanted = {.moving = 1}};
    return parse(&request, bytes, size, error).skin;
}

struct kiln_skin *kiln_skin_load(struct kiln_loader *loader, const char *path,
                                 struct kiln_error *error)
{
    struct request request = {.loader = loader, .name = path, .wanted = {.moving = 1}};
    return load(&request, error).skin;
}

struct kiln_rig *kiln_rig_parse(const void *bytes, size_t size, const char *name,
                                struct kiln_error *error)
{
    struct request request = {.name = name, .wanted = {.rig = 1}};
    return parse(&request, bytes, size, error).rig;
}

struct kiln_rig *kiln_rig_load(struct kiln_loader *loader, const char *path,
                               struct kiln_error *error)
{
    struct request request = {.loader = loader, .name = path, .wanted = {.rig = 1}};
    return load(&request, error).rig;
}
