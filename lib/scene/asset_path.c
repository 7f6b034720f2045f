/* This file resolves the paths of assets that a scene names, and refuses those outside the asset
 * root. A scene may be hostile: a path that leaves the folder by its text is refused before the
 * file system is asked, and one that leaves it by a link is refused by its real path. */
#include "scene/asset_path.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/atlas/builtin.h"
#include "asset/atlas/cells_in.h"
#include "base/budget.h"
#include "base/error.h"
#include "base/file.h"
#include "base/file_in.h"
#include "base/log.h"
#include "base/shown.h"

const char *kiln_asset_root(struct kiln_arena *arena, const char *root, const char *file,
                            struct kiln_error *error)
{
    char *folder = NULL;
    if (root) {
        folder = strdup(root);
    } else {
        const char *slash = file ? strrchr(file, '/') : NULL;
        folder = !slash ? strdup(".") : slash == file ? strdup("/") : NULL;
        if (slash && !folder)
            folder = strndup(file, (size_t)(slash - file));
    }
    char *real = folder ? realpath(folder, NULL) : NULL;
    struct stat status;
    const char *result = NULL;
    if (!folder)
        kiln_error_no_memory(error, "reading a scene");
    else if (!real || stat(real, &status) != 0)
        kiln_error_set_errno(error, KILN_INVALID_INPUT, errno, "asset root '%s'", folder);
    else if (!S_ISDIR(status.st_mode))
        kiln_error_set(error, KILN_INVALID_INPUT, "asset root '%s' is not a folder", folder);
    else if (!(result = kiln_arena_text(arena, real, strlen(real))))
        kiln_error_no_memory(error, "reading a scene");
    free(real);
    free(folder);
    return result;
}

/* Returns whether a relative path leaves its start by "..", whether or not it exists. */
static bool climbs_out(const char *path)
{
    int depth = 0;
    while (*path) {
        size_t length = strcspn(path, "/");
        if (length == 2 && path[0] == '.' && path[1] == '.')
            depth--;
        else if (length > 0 && !(length == 1 && path[0] == '.'))
            depth++;
        if (depth < 0)
            return true;
        path += length + (path[length] == '/');
    }
    return false;
}

/* Returns whether a path below the root reaches a file outside by a link. It must not tell whether
 * something is there: the kernel stops at the link, and only a link that is absolute may lead back
 * into the root. */
static bool leads_out(const char *root, const char *path, const char *real)
{
    const int file = kiln_file_open_below(root, path, O_PATH | O_CLOEXEC);
    const bool is_crossing = file < 0 && errno == EXDEV;
    if (file >= 0)
        close(file);
    return is_crossing ? !real || !kiln_path_below(real, root)
                       : real && !kiln_path_below(real, root);
}

/* Returns an error's message without the absolute path that it begins with; the caller's message
 * names the file as the scene does. */
static const char *reason_of(const struct kiln_error *error, const char *path)
{
    char shown[KILN_PATH_SIZE];
    kiln_shown(shown, sizeof shown, path);
    const size_t length = strlen(shown);
    if (strncmp(error->message, shown, length) != 0)
        return error->message;
    return error->message + length + strspn(error->message + length, ": ");
}

/* Reports a faulty file as invalid input at its place in the scene. Errors of memory and time keep
 * their code. */
static bool fail_as(struct kiln_reader *reader, const struct kiln_error *error)
{
    if (error->code != KILN_INVALID_INPUT && error->code != KILN_IO)
        reader->error->code = error->code;
    return false;
}

bool kiln_asset_fail(struct kiln_reader *reader, const struct kiln_node *root, const char *path,
                     const char *file, const struct kiln_error *error)
{
    kiln_reader_error_at(reader, root, path, "'%s': %s",
                         kiln_asset_name(kiln_reader_scene(reader), file), reason_of(error, file));
    return fail_as(reader, error);
}

/* Places a warning of the loader in the scene. */
struct place {
    struct kiln_reader *reader;
    const struct kiln_node *node;
    const char *name; /* the file as the scene names it */
};

static void warn_at(void *user, const char *path, const char *text)
{
    (void)path;
    const struct place *place = user;
    struct kiln_reader *reader = place->reader;
    struct kiln_error found = {0}, *kept = reader->error;
    reader->error = &found;
    kiln_reader_error(reader, place->node, "'%s': %s", place->name, text);
    reader->error = kept;
    kiln_log_write(reader->log, KILN_LOG_WARNING, "%s", found.message);
}

static bool check_contents(struct kiln_reader *reader, const struct kiln_node *node,
                           kiln_check_file *check, const char *path, const char *name)
{
    struct kiln_error error = {0};
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    struct place place = {reader, node, name};
    if (reader->log)
        kiln_loader_set_warn(scene->loader, (struct kiln_loader_warn){warn_at, &place});
    const bool ok = check(scene->loader, path, &error);
    kiln_loader_set_warn(scene->loader, (struct kiln_loader_warn){.write = NULL});
    if (ok)
        return kiln_budget_is_kept(scene->budget, reader->error);
    kiln_reader_error(reader, node, "'%s': %s", name, reason_of(&error, path));
    return fail_as(reader, &error);
}

bool kiln_asset_join(struct kiln_reader *reader, const struct kiln_node *node,
                     char path[KILN_PATH_SIZE])
{
    const char *folder = node->origin->folder;
    char quoted[64];
    kiln_node_quote(quoted, node->text);
    const int length = snprintf(path, KILN_PATH_SIZE, "%s%s%s", folder ? folder : "",
                                folder ? "/" : "", node->text);
    if (length >= KILN_PATH_SIZE)
        return kiln_reader_error(reader, node, "the path of a file is too long");
    if (node->text[0] == '/' || climbs_out(path))
        return kiln_reader_error(reader, node,
                                 "'%s' is outside the asset root; a path starts at the scene's "
                                 "folder and stays below it",
                                 quoted);
    return true;
}

const char *kiln_asset_reason(int reason, char room[256])
{
    char text[128];
    snprintf(room, 256, "%s%s", strerror_r(reason, text, sizeof text),
             reason == ENOENT ? "; a path starts at the scene's folder, or at the asset root that "
                                "is given instead"
                              : "");
    return room;
}

bool kiln_read_file_asset(struct kiln_reader *reader, const struct kiln_node *node,
                          kiln_check_file *check, const char **asset)
{
    const char *root = kiln_reader_scene(reader)->asset_root;
    char quoted[64], path[KILN_PATH_SIZE];
    kiln_node_quote(quoted, node->text);
    if (!kiln_asset_join(reader, node, path))
        return false;

    struct kiln_text joined = {0};
    kiln_text_add(&joined, "%s/%s", root, path);
    char *real = joined.failed ? NULL : realpath(joined.data, NULL);
    const int reason = joined.failed ? ENOMEM : errno;
    kiln_text_free(&joined);
    if (!real && reason == ENOMEM)
        return kiln_reader_out_of_memory(reader);
    if (leads_out(root, path, real)) {
        free(real);
        return kiln_reader_error(reader, node, "'%s' leads outside the asset root", quoted);
    }
    if (!real) {
        char room[256];
        return kiln_reader_error(reader, node, "cannot open '%s': %s", quoted,
                                 kiln_asset_reason(reason, room));
    }
    struct stat status;
    bool ok = false;
    if (stat(real, &status) != 0 || !S_ISREG(status.st_mode))
        kiln_reader_error(reader, node, "'%s' is not a file", quoted);
    else if (!check || check_contents(reader, node, check, real, quoted)) {
        ok = kiln_reader_copy_text(reader, real, asset) &&
             (kiln_scene_add_file(kiln_reader_scene(reader), *asset, "a file of the scene") ||
              kiln_reader_out_of_memory(reader));
    }
    free(real);
    return ok;
}

bool kiln_read_asset(struct kiln_reader *reader, const struct kiln_node *node, const char **asset)
{
    const char *name = kiln_builtin_name_of(node->text);
    if (!name)
        return kiln_read_file_asset(reader, node, kiln_cells_check, asset);
    if (kiln_builtin_exists(name))
        return kiln_reader_copy_text(reader, node->text, asset);
    const char *names[32];
    size_t count = 0;
    while (count < 32 && (names[count] = kiln_builtin_name_at(count)))
        count++;
    char quoted[64], suggestion[512];
    kiln_node_quote(quoted, node->text);
    kiln_option_suggest(suggestion, sizeof suggestion, name, names, count);
    return kiln_reader_error(reader, node, "unknown built-in asset '%s'%s", quoted, suggestion);
}

bool kiln_asset_add_hash(const struct kiln_scene *scene, const char *asset, struct kiln_text *text,
                         struct kiln_error *error)
{
    const struct kiln_loader_file file = {asset, "asset", "regular", SIZE_MAX};
    char hex[65];
    if (asset[0] != '/') /* built-in texture, or none */
        return true;
    if (!kiln_loader_hash(scene->loader, &file, hex, error))
        return false;
    kiln_text_add(text, "%s\n", hex);
    return true;
}

const char *kiln_asset_name(const struct kiln_scene *scene, const char *asset)
{
    if (kiln_builtin_name_of(asset))
        return asset;
    const char *relative = kiln_path_below(asset, scene->asset_root);
    return relative ? relative : asset;
}
