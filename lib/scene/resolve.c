/* Resolves the tree of a scene, step by step. The steps are those of lib/option; this file knows
 * the folders: where included files and files of parameters lie, and which of them a scene may
 * open. An included file may be a stranger's, as the scene may be: it is opened below the asset
 * root by the kernel's rule, once, and counts as a file of the scene. */
#include "scene/resolve.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/atlas/builtin.h"
#include "base/error.h"
#include "base/file.h"
#include "base/file_in.h"
#include "option/include.h"
#include "option/override.h"
#include "option/params.h"
#include "option/use.h"
#include "scene/asset_path.h"
#include "scene/params.h"
#include "scene/place.h"

/* What the callbacks of includes know. */
struct opening {
    struct kiln_reader *reader;
    const struct kiln_scene_source *source;
    size_t size; /* bytes of all files of the scene so far */
};

/* ---- files ----------------------------------------------------------------------------------- */

/* Lists a file that was opened among the files of the scene. */
static bool list_file(struct kiln_reader *reader, const char *path, const char *what,
                      const struct stat *status)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    for (const struct kiln_scene_file *file = scene->files; file; file = file->next) {
        if (file->status && file->status->st_dev == status->st_dev &&
            file->status->st_ino == status->st_ino)
            return true;
    }
    struct stat *copy = kiln_arena_alloc(scene->arena, 1, sizeof *copy);
    const char *name = kiln_arena_text(scene->arena, path, strlen(path));
    if (!copy || !name || !kiln_scene_add_file(scene, name, what))
        return kiln_reader_out_of_memory(reader);
    *copy = *status;
    scene->files->status = copy;
    return true;
}

/* Returns the path of an included file for people, as if it had been given like that of the scene.
 */
static const char *shown_path(const struct opening *opening, const char *path)
{
    const struct kiln_scene_source *source = opening->source;
    const char *root = source->params->asset_root;
    const char *slash = source->path ? strrchr(source->path, '/') : NULL;
    if (root)
        return kiln_arena_format(opening->reader->scratch, "%s/%s", root, path);
    return kiln_arena_format(opening->reader->scratch, "%.*s%s",
                             slash ? (int)(slash + 1 - source->path) : 0, slash ? source->path : "",
                             path);
}

/* Reports a faulty file at the scalar that names it, without the path that its message begins
 * with. */
static bool refuse_file(struct kiln_reader *reader, const struct kiln_node *node, const char *path,
                        const struct kiln_error *error)
{
    const size_t length = strlen(path);
    const char *reason = error->message;
    char quoted[64];
    kiln_node_quote(quoted, node->text);
    if (strncmp(reason, path, length) == 0)
        reason += length + strspn(reason + length, ": ");
    kiln_reader_error(reader, node, "'%s': %s", quoted, reason);
    if (error->code != KILN_INVALID_INPUT && error->code != KILN_IO)
        reader->error->code = error->code;
    return false;
}

/* Reads an open file into the scratch arena, and lists it. */
static bool take_file(struct opening *opening, const struct kiln_node *node, int descriptor,
                      const char *path, struct kiln_included *file)
{
    struct kiln_reader *reader = opening->reader;
    struct kiln_error error = {0};
    struct stat status;
    char *text = kiln_text_file_take(descriptor, path, "a scene file", KILN_MAX_SCENE_SIZE,
                                     &file->size, &status, &error);
    if (!text)
        return refuse_file(reader, node, path, &error);
    opening->size += file->size;
    file->text = kiln_arena_text(reader->scratch, text, file->size);
    file->device = status.st_dev;
    file->inode = status.st_ino;
    free(text);
    if (!file->text)
        return kiln_reader_out_of_memory(reader);
    if (opening->size > KILN_MAX_SCENE_SIZE)
        return kiln_reader_error(reader, node,
                                 "the scene and what it includes have more than the %d bytes that "
                                 "are allowed",
                                 KILN_MAX_SCENE_SIZE);
    return list_file(reader, path, "a file of the scene", &status);
}

/* Makes the origin of an included file, whose path is relative to the asset root. */
static bool make_origin(struct opening *opening, const char *path, const char *name,
                        const struct kiln_node_link *link, struct kiln_included *file)
{
    struct kiln_arena *arena = opening->reader->scratch;
    struct kiln_origin *origin = kiln_arena_alloc(arena, 1, sizeof *origin);
    const char *slash = strrchr(path, '/');
    if (!origin)
        return kiln_reader_out_of_memory(opening->reader);
    *origin = kiln_scene_origin(name);
    origin->counts = opening->reader->counts;
    origin->via = link;
    origin->folder = slash ? kiln_arena_text(arena, path, (size_t)(slash - path)) : NULL;
    file->origin = origin;
    return !slash || origin->folder || kiln_reader_out_of_memory(opening->reader);
}

static bool read_included(void *user, const struct kiln_node *node,
                          const struct kiln_node_link *link, struct kiln_included *file)
{
    struct opening *opening = user;
    struct kiln_reader *reader = opening->reader;
    char path[KILN_PATH_SIZE], quoted[64], room[256];
    kiln_node_quote(quoted, node->text);
    if (!kiln_asset_join(reader, node, path))
        return false;
    const char *name = shown_path(opening, path);
    if (!name)
        return kiln_reader_out_of_memory(reader);
    const int descriptor =
        kiln_file_open_below(kiln_reader_scene(reader)->asset_root, path, KILN_FILE_FLAGS);
    if (descriptor < 0 && (errno == EXDEV || errno == ELOOP))
        return kiln_reader_error(reader, node, "'%s' leads outside the asset root", quoted);
    if (descriptor < 0)
        return kiln_reader_error(reader, node, "cannot open '%s': %s", quoted,
                                 kiln_asset_reason(errno, room));
    const bool ok = take_file(opening, node, descriptor, name, file) &&
                    make_origin(opening, path, name, link, file);
    close(descriptor);
    return ok;
}

/* Checks the version of an included file, which the merged tree shows only for the first one. */
static bool check_version(void *user, const struct kiln_node *root)
{
    struct opening *opening = user;
    struct kiln_reader *reader = opening->reader;
    const struct kiln_node *version = kiln_node_entry(root, "kiln");
    uint32_t number;
    if (!version)
        return true;
    const size_t before = kiln_reader_enter(reader, "kiln");
    const bool ok =
        kiln_read_whole(reader, kiln_option_find(kiln_options_root, "kiln"), version, &number);
    kiln_reader_leave(reader, before);
    return ok;
}

bool kiln_scene_include(struct kiln_reader *reader, struct kiln_node *root,
                        const struct kiln_scene_source *source)
{
    struct opening opening = {reader, source, source->size};
    const struct kiln_include_loader loader = {
        .read = read_included, .check = check_version, .user = &opening};
    struct kiln_included own = {.text = NULL};
    if (source->status) {
        own.device = source->status->st_dev;
        own.inode = source->status->st_ino;
    }
    return kiln_include(reader, kiln_options_root, root, &own, &loader);
}

/* ---- parameters ------------------------------------------------------------------------------ */

/* Checks the path that a parameter of the kind `file` has. */
static bool check_path(struct kiln_reader *reader, const struct kiln_node *path)
{
    char joined[KILN_PATH_SIZE];
    return kiln_builtin_name_of(path->text) || strcmp(path->text, "none") == 0 ||
           kiln_asset_join(reader, path, joined);
}

/* Gives parameters the values of a file, which is the operator's or, below the asset root, is
 * opened as the scene is. */
static bool read_params_file(struct kiln_reader *reader, const char *path,
                             const struct kiln_scene_params *params)
{
    struct stat status;
    size_t size = 0;
    struct kiln_origin *origin = kiln_arena_alloc(reader->scratch, 1, sizeof *origin);
    const char *name = kiln_arena_text(reader->scratch, path, strlen(path));
    if (!origin || !name)
        return kiln_reader_out_of_memory(reader);
    *origin = (struct kiln_origin){
        .name = name, .has_lines = true, .kind = "a file of parameters", .counts = reader->counts};
    const int file = kiln_scene_open(path, params->asset_root, reader->error);
    if (file < 0)
        return false;
    char *text = kiln_text_file_take(file, path, origin->kind, KILN_MAX_SCENE_SIZE, &size, &status,
                                     reader->error);
    close(file);
    if (!text)
        return false;
    struct kiln_node *values = kiln_node_parse(reader->scratch, text, size, origin, reader->error);
    free(text);
    return values && list_file(reader, name, "the parameters", &status) &&
           kiln_params_set_all(reader, values);
}

/* Returns the name of the parameter that an override "params.NAME=VALUE" gives a value, or NULL. */
static const char *param_name(struct kiln_reader *reader, const char *override)
{
    static const char prefix[] = "params.";
    const size_t length = sizeof prefix - 1;
    const char *equals = strchr(override, '=');
    if (!equals || strncmp(override, prefix, length) != 0 || equals == override + length)
        return NULL;
    return kiln_arena_text(reader->scratch, override + length,
                           (size_t)(equals - override) - length);
}

static bool is_of_param(const char *override)
{
    return strncmp(override, "params.", 7) == 0;
}

static bool set_param(struct kiln_reader *reader, const char *override)
{
    const struct kiln_origin *origin;
    struct kiln_node *value = kiln_override_value(reader, override, &origin);
    if (!value)
        return false;
    const char *name = param_name(reader, override);
    const struct kiln_node place = {.origin = origin};
    return name ? kiln_params_set(reader, name, &place, value)
                : kiln_node_error(&place, reader->error, "a part of the key is empty");
}

static bool read_params(struct kiln_reader *reader, struct kiln_node *root,
                        const struct kiln_scene_params *params)
{
    if (!kiln_params_declare(reader, kiln_node_take(root, "params")))
        return false;
    reader->params->check_file = check_path;
    for (size_t i = 0; i < params->params_file_count; i++) {
        if (!read_params_file(reader, params->params_files[i], params))
            return false;
    }
    for (size_t i = 0; i < params->override_count; i++) {
        if (is_of_param(params->overrides[i]) && !set_param(reader, params->overrides[i]))
            return false;
    }
    return kiln_params_check(reader) && kiln_scene_keep_params(reader);
}

/* ---- all ------------------------------------------------------------------------------------- */

bool kiln_scene_resolve(struct kiln_reader *reader, struct kiln_node *root,
                        const struct kiln_scene_source *source)
{
    const struct kiln_scene_params *params = source->params;
    if (!kiln_scene_include(reader, root, source) || !read_params(reader, root, params) ||
        !kiln_use(reader, kiln_options_root, root))
        return false;
    for (size_t i = 0; i < params->override_count; i++) {
        kiln_reader_leave(reader, 0);
        if (!is_of_param(params->overrides[i]) &&
            !kiln_override(reader, kiln_options_root, root, params->overrides[i]))
            return false;
    }
    return kiln_params_replace(reader, root);
}
