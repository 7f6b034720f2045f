/* This file loads a scene from a file or a text: it parses the text, applies overrides, reads the
 * options, validates them, and takes the scene's hash. */
#include "scene/load.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/geometry/rig.h"
#include "asset/loader/loader.h"
#include "base/budget.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/sized.h"
#include "scene/asset_path.h"
#include "scene/baked.h"
#include "scene/fast_nodes.h"
#include "scene/light_notes.h"
#include "scene/mesh_notes.h"
#include "scene/node_cache.h"
#include "scene/parts.h"
#include "scene/place.h"
#include "scene/resolve.h"
#include "scene/small_steps.h"
#include "scene/source.h"
#include "scene/validate.h"
#include "scene/work.h"

/* The limits whose counts start at 0 again with each scene of a job. */
static const enum kiln_limit OF_A_SCENE[] = {KILN_LIMIT_asset_pixels, KILN_LIMIT_asset_bytes,
                                             KILN_LIMIT_triangles};

static bool keep_keys(struct kiln_reader *reader, struct kiln_scene *scene)
{
    /* At least one, so that the table is never an empty buffer. */
    size_t count = reader->key_count ? reader->key_count : 1;
    float4 *keys = kiln_arena_alloc(reader->arena, count, sizeof *keys);
    if (!keys)
        return kiln_reader_out_of_memory(reader);
    if (reader->keys)
        memcpy(keys, reader->keys, reader->key_count * sizeof *keys);
    scene->keys = keys;
    scene->key_count = reader->key_count;
    return true;
}

static bool add_backdrop_hashes(const struct kiln_scene *scene, struct kiln_text *text,
                                struct kiln_error *error)
{
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    if (backdrop->sky_image && !kiln_asset_add_hash(scene, backdrop->sky_image, text, error))
        return false;
    if (backdrop->floor_image && !kiln_asset_add_hash(scene, backdrop->floor_image, text, error))
        return false;
    for (uint32_t i = 0; i < backdrop->object_count; i++) {
        const struct kiln_object *object = &backdrop->objects[i];
        if (object->kind == KILN_OBJECT_TERRAIN && object->file &&
            !kiln_asset_add_hash(scene, object->file, text, error))
            return false;
        if (object->kind == KILN_OBJECT_MESH)
            kiln_text_add(text, "%s\n", object->shown->hash);
    }
    return true;
}

/* Adds the hashes of the files of air that move gas. */
static bool add_gas_hashes(const struct kiln_scene *scene, struct kiln_text *text,
                           struct kiln_error *error)
{
    bool read = true;
    for (uint32_t i = 0; i < scene->gas_count; i++) {
        const struct kiln_force *force;
        for (uint32_t k = 0; read && (force = kiln_gas_force(&scene->gas[i], k)) != NULL; k++)
            if (force->kind == KILN_FORCE_FIELD)
                read = kiln_asset_add_hash(scene, force->file, text, error);
    }
    return read;
}

/* Hashes the printed scene and the contents of its textures, meshes and grids, so that a changed
 * file makes another scene. */
static bool take_hash(struct kiln_scene *scene, struct kiln_error *error)
{
    struct kiln_text text;
    bool ok = kiln_print_scene(scene, KILN_PART_HASHED, &text), read = true;
    for (uint32_t i = 0; ok && read && i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        for (uint32_t k = 0; read && k < look->atlas_count; k++)
            read = kiln_asset_add_hash(scene, look->atlas[k], &text, error);
        read =
            read && kiln_asset_add_hash(scene, look->motion, &text, error) &&
            (!look->motion_layout || kiln_asset_add_hash(scene, look->motion_layout, &text, error));
        if (look->shape == KILN_SHAPE_MESH)
            kiln_text_add(&text, "%s\n", look->mesh.shown->hash);
        const struct kiln_force *force;
        for (uint32_t k = 0; read && (force = kiln_system_force(&scene->systems[i], k)); k++)
            if (force->kind == KILN_FORCE_FIELD)
                read = kiln_asset_add_hash(scene, force->file, &text, error);
    }
    for (uint32_t i = 0; i < scene->node_count; i++) {
        if (scene->nodes[i].file)
            kiln_text_add(&text, "%s\n", kiln_rig_hash(scene->nodes[i].rig));
    }
    read = read && (!ok || (add_gas_hashes(scene, &text, error) &&
                            add_backdrop_hashes(scene, &text, error) &&
                            kiln_sources_add_hashes(scene, false, &text, error)));
    ok = ok && !text.failed;
    if (ok)
        kiln_hash_sha256(text.data, text.length, scene->hash);
    kiln_text_free(&text);
    if (!read)
        return false;
    return ok || kiln_error_no_memory(error, "reading a scene");
}

static bool build(struct kiln_reader *reader, const char *text,
                  const struct kiln_scene_source *source, kiln_scene_estimate *estimate)
{
    const struct kiln_scene_params *params = source->params;
    struct kiln_scene *scene = kiln_reader_scene(reader);
    struct kiln_node *root =
        kiln_node_parse(reader->scratch, text, source->size, reader->origin, reader->error);
    if (!root)
        return false;
    if (root->kind != KILN_NODE_MAP)
        return kiln_reader_expected(reader, root, "a mapping of keys");
    if (!kiln_scene_resolve(reader, root, source))
        return false;
    scene->tree = params->keep_origins ? root : NULL;
    const struct kiln_loader_params loading = {.root = scene->asset_root,
                                               .cancel = params->cancel,
                                               .stop = params->stop,
                                               .user = params->user,
                                               .budget = scene->budget};
    scene->loader = kiln_loader_create(&loading);
    scene->meshes = kiln_mesh_library_create(scene->loader);
    if (!scene->loader || !scene->meshes)
        return kiln_reader_out_of_memory(reader);
    for (size_t i = 0; i < sizeof OF_A_SCENE / sizeof *OF_A_SCENE; i++)
        kiln_budget_reset(scene->budget, OF_A_SCENE[i]);
    if (!kiln_read_members(reader, kiln_options_root, root, scene) || !keep_keys(reader, scene))
        return false;
    if (!kiln_validate(reader, root) || !kiln_work_check(reader, root, estimate) ||
        !take_hash(scene, reader->error) || !kiln_budget_is_kept(scene->budget, reader->error))
        return false;
    /* No frame may be remembered before all that it depends on is read. */
    if (scene->node_count > 0 &&
        !(scene->node_cache = kiln_node_cache_create(reader->arena, scene->node_count)))
        return kiln_reader_out_of_memory(reader);
    kiln_small_steps_warn(reader, root);
    kiln_fast_nodes_warn(reader, root);
    kiln_light_notes_warn(reader, root);
    kiln_mesh_notes_warn(reader, root, &params->log);
    return true;
}

/* Says that a limit of the whole job was reached, if one was: the line that was read at that time,
 * or the file that was decoded, is not at fault. */
static void blame_limit(const struct kiln_scene *scene, struct kiln_error *error)
{
    struct kiln_error limit = {0};
    if (error->code == KILN_OVER_LIMIT && !kiln_budget_is_kept(scene->budget, &limit))
        kiln_error_set(error, KILN_OVER_LIMIT, "loading %s: %s", scene->name, limit.message);
}

/* Lists the scene's own file, which another file may have replaced under its name by now. */
static bool add_own_file(struct kiln_scene *scene, const struct kiln_scene_source *file)
{
    if (!kiln_scene_add_file(scene, scene->name, "the scene"))
        return false;
    struct stat *status = kiln_arena_alloc(scene->arena, 1, sizeof *status);
    if (!status)
        return false;
    *status = *file->status;
    scene->files->status = status;
    return true;
}

static struct kiln_scene *create(const char *text, const char *name,
                                 const struct kiln_scene_source *source,
                                 kiln_scene_estimate *estimate, struct kiln_error *error)
{
    const struct kiln_scene_params *params = source->params;
    struct kiln_node_counts counts = {0};
    struct kiln_arena *arena = kiln_arena_create(), *scratch = kiln_arena_create();
    struct kiln_scene *scene = calloc(1, sizeof *scene);
    const double before_s = kiln_clock_cpu_seconds();
    char *name_copy = arena ? kiln_arena_text(arena, name, strlen(name)) : NULL;
    bool ok = false;
    struct kiln_origin *origin = scratch ? kiln_arena_alloc(scratch, 1, sizeof *origin) : NULL;
    if (!origin || !scene || !name_copy) {
        kiln_error_no_memory(error, "reading a scene");
    } else {
        *origin = kiln_scene_origin(name_copy);
        origin->counts = &counts;
        struct kiln_reader reader = {.origin = origin,
                                     .arena = arena,
                                     .scratch = scratch,
                                     .error = error,
                                     .log = &params->log,
                                     .target = scene,
                                     .counts = &counts};
        kiln_handle_mark(&scene->handle, KILN_HANDLE_SCENE);
        scene->arena = arena;
        scene->name = name_copy;
        scene->budget = params->budget;
        scene->asset_root = kiln_asset_root(arena, params->asset_root, source->path, error);
        ok = scene->asset_root &&
             (!source->path || add_own_file(scene, source) || kiln_reader_out_of_memory(&reader)) &&
             build(&reader, text, source, estimate);
        kiln_loader_stop_counting(scene->loader, params->budget);
        scene->loading_cpu_s = kiln_clock_cpu_seconds() - before_s;
    }
    if (ok && scene->tree)
        scene->tree_arena = scratch;
    else
        kiln_arena_destroy(&scratch);
    if (!ok && scene) {
        blame_limit(scene, error);
        kiln_mesh_library_destroy(&scene->meshes);
        kiln_loader_destroy(&scene->loader);
    }
    if (!ok) {
        kiln_arena_destroy(&arena);
        free(scene);
        scene = NULL;
    }
    return scene;
}

struct kiln_scene *kiln_scene_load_with(const char *path, const struct kiln_scene_params *given,
                                        kiln_scene_estimate *estimate, struct kiln_error *error)
{
    size_t size = 0;
    struct stat status;
    struct kiln_scene_params params = kiln_scene_defaults();
    const int file = kiln_sized_take(&params, given, "kiln_scene_params", error)
                         ? kiln_scene_open(path, params.asset_root, error)
                         : -1;
    if (file < 0)
        return NULL;
    char *text =
        kiln_text_file_take(file, path, "a scene file", KILN_MAX_SCENE_SIZE, &size, &status, error);
    close(file);
    if (!text)
        return NULL;
    const struct kiln_scene_source source = {path, &status, size, &params};
    struct kiln_scene *scene = create(text, path, &source, estimate, error);
    free(text);
    return scene;
}

struct kiln_scene *kiln_scene_parse_with(const char *text, size_t size, const char *name,
                                         const struct kiln_scene_params *given,
                                         kiln_scene_estimate *estimate, struct kiln_error *error)
{
    struct kiln_scene_params params = kiln_scene_defaults();
    if (!kiln_sized_take(&params, given, "kiln_scene_params", error))
        return NULL;
    char *copy = size < SIZE_MAX ? malloc(size + 1) : NULL; /* with a zero byte after it */
    if (!copy) {
        kiln_error_no_memory(error, "reading a scene");
        return NULL;
    }
    memcpy(copy, text, size);
    copy[size] = '\0';
    struct kiln_scene *scene = NULL;
    if (size > KILN_MAX_SCENE_SIZE)
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the scene file has %zu bytes; at most %d are allowed", name, size,
                       KILN_MAX_SCENE_SIZE);
    else
        scene = create(copy, name, &(struct kiln_scene_source){NULL, NULL, size, &params}, estimate,
                       error);
    free(copy);
    return scene;
}

/* Reads the tree of a scene file and its includes, for a caller that needs no valid scene. The
 * scene only has what includes need. NULL with an error. */
static struct kiln_node *read_tree(struct kiln_reader *reader, const char *path,
                                   struct kiln_error *error)
{
    size_t size = 0;
    struct stat status;
    const struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_scene *scene = kiln_reader_scene(reader);
    scene->asset_root = kiln_asset_root(reader->arena, NULL, path, error);
    const int file = scene->asset_root ? kiln_scene_open(path, NULL, error) : -1;
    char *text = file >= 0 ? kiln_text_file_take(file, path, "a scene file", KILN_MAX_SCENE_SIZE,
                                                 &size, &status, error)
                           : NULL;
    if (file >= 0)
        close(file);
    const struct kiln_scene_source source = {path, &status, size, &params};
    struct kiln_node *root =
        text ? kiln_node_parse(reader->scratch, text, size, reader->origin, error) : NULL;
    free(text);
    if (!root || root->kind != KILN_NODE_MAP)
        return root;
    return kiln_scene_include(reader, root, &source) ? root : NULL;
}

bool kiln_scene_visit_names(const char *path, const char *key,
                            void (*visit)(void *user, const char *name), void *user,
                            struct kiln_error *error)
{
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_scene *scene = calloc(1, sizeof *scene);
    struct kiln_node_counts counts = {0};
    struct kiln_origin origin = kiln_scene_origin(path);
    origin.counts = &counts;
    struct kiln_reader reader = {.origin = &origin,
                                 .arena = arena,
                                 .scratch = arena,
                                 .error = error,
                                 .target = scene,
                                 .counts = &counts};
    const struct kiln_node *root = NULL;
    if (!arena || !scene) {
        kiln_error_no_memory(error, "reading a scene");
    } else {
        scene->arena = arena;
        root = read_tree(&reader, path, error);
    }
    const struct kiln_node *map = root ? kiln_node_entry(root, key) : NULL;
    if (map && map->kind == KILN_NODE_MAP) {
        for (const struct kiln_node *entry = map->first; entry; entry = entry->next) {
            if (kiln_option_is_name(entry->key->text))
                visit(user, entry->key->text);
        }
    }
    bool ok = root != NULL;
    kiln_arena_destroy(&arena);
    free(scene);
    return ok;
}
