/* Lists figures by their sidecars, which it finds below folders and beside figures, for kiln figure
 * --check. */
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "figure/record.h"

enum { MAX_DEPTH = 64 };

struct kiln_figure_list {
    struct kiln_arena *arena;
    struct kiln_figure_entry *entries;
    size_t count, capacity;
};

static struct kiln_figure_entry *new_entry(struct kiln_figure_list *list)
{
    if (list->count == list->capacity) {
        size_t capacity = list->capacity ? 2 * list->capacity : 16;
        struct kiln_figure_entry *grown = kiln_arena_alloc(list->arena, capacity, sizeof *grown);
        if (!grown)
            return NULL;
        if (list->count)
            memcpy(grown, list->entries, list->count * sizeof *grown);
        list->entries = grown;
        list->capacity = capacity;
    }
    return &list->entries[list->count++];
}

/* Fills in the members of an entry that follow from the sidecar's path; false when memory is
 * short. */
static bool start_entry(struct kiln_arena *arena, struct kiln_figure_entry *entry, const char *path)
{
    size_t length = strlen(path) - (sizeof KILN_RECORD_SUFFIX - 1);
    *entry = (struct kiln_figure_entry){.sidecar = kiln_arena_format(arena, "%s", path),
                                        .figure = kiln_arena_text(arena, path, length),
                                        .folder = ".",
                                        .problem = NULL};
    return entry->sidecar && entry->figure;
}

static bool add_entry(struct kiln_figure_list *list, const char *path, struct kiln_error *error)
{
    struct kiln_figure_entry *entry = new_entry(list);
    struct kiln_error *problem = kiln_arena_alloc(list->arena, 1, sizeof *problem);
    if (!entry || !problem || !start_entry(list->arena, entry, path))
        return kiln_error_no_memory(error, "the figures");
    *problem = (struct kiln_error){0};
    const struct kiln_record *record = kiln_record_read(list->arena, path, problem);
    if (!record) {
        entry->problem = problem;
        return true;
    }
    const char *slash = strrchr(path, '/');
    size_t folder = slash ? (size_t)(slash - path) + 1 : 0;
    entry->folder = kiln_arena_format(
        list->arena, "%.*s%s", *record->folder == '/' ? 0 : (int)folder, path, record->folder);
    entry->command = record->command;
    entry->command_count = record->command_count;
    return entry->folder || kiln_error_no_memory(error, "the figures");
}

/* Adds an entry with a problem for a path that leads to no figure. The search goes on with the
 * other paths. */
static bool add_problem(struct kiln_figure_list *list, const char *path,
                        const struct kiln_error *problem, struct kiln_error *error)
{
    struct kiln_figure_entry *entry = new_entry(list);
    const char *name = kiln_arena_format(list->arena, "%s", path);
    struct kiln_error *copy = kiln_arena_alloc(list->arena, 1, sizeof *copy);
    if (!entry || !name || !copy)
        return kiln_error_no_memory(error, "the figures");
    *copy = *problem;
    *entry =
        (struct kiln_figure_entry){.sidecar = name, .figure = name, .folder = ".", .problem = copy};
    return true;
}

static bool is_sidecar(const char *path)
{
    size_t length = strlen(path), end = sizeof KILN_RECORD_SUFFIX - 1;
    return length > end && strcmp(path + length - end, KILN_RECORD_SUFFIX) == 0;
}

static bool search(struct kiln_figure_list *list, const char *folder, int depth,
                   struct kiln_error *error)
{
    struct dirent **names;
    struct kiln_error problem = {0};
    int count = scandir(folder, &names, NULL, alphasort);
    if (count < 0) {
        kiln_error_set_errno(&problem, KILN_IO, errno, "%s: the folder cannot be read", folder);
        return add_problem(list, folder, &problem, error);
    }
    bool ok = true;
    for (int i = 0; i < count; i++) {
        char path[KILN_PATH_SIZE];
        struct stat status;
        const char *name = names[i]->d_name;
        ok = ok && (*name == '.' || kiln_path_join(path, folder, name, error));
        if (ok && *name != '.' && lstat(path, &status) == 0) {
            if (S_ISDIR(status.st_mode) && depth < MAX_DEPTH)
                ok = search(list, path, depth + 1, error);
            else if (S_ISREG(status.st_mode) && is_sidecar(path))
                ok = add_entry(list, path, error);
        }
        free(names[i]);
    }
    free(names);
    return ok;
}

/* Adds the figure at `path` by its sidecar. The figure's own file may be missing. Without a
 * sidecar, it adds an entry with a problem. */
static bool add_figure(struct kiln_figure_list *list, const char *path, bool is_there,
                       struct kiln_error *error)
{
    char sidecar[KILN_PATH_SIZE];
    int length = snprintf(sidecar, sizeof sidecar, "%s%s", path, KILN_RECORD_SUFFIX);
    bool fits = length >= 0 && length < KILN_PATH_SIZE;
    if (fits && access(sidecar, F_OK) == 0)
        return add_entry(list, sidecar, error);
    struct kiln_error problem = {0};
    if (!is_there)
        kiln_error_set_errno(&problem, KILN_INVALID_INPUT, ENOENT, "%s", path);
    else
        kiln_error_set(&problem, KILN_INVALID_INPUT,
                       "%s: expected a folder, a figure that has a sidecar (NAME%s) beside it, or "
                       "a sidecar",
                       path, KILN_RECORD_SUFFIX);
    return add_problem(list, path, &problem, error);
}

static bool add_path(struct kiln_figure_list *list, const char *path, struct kiln_error *error)
{
    struct stat status;
    struct kiln_error problem = {0};
    if (stat(path, &status) != 0) {
        if (errno == ENOENT)
            return add_figure(list, path, false, error);
        kiln_error_set_errno(&problem, KILN_INVALID_INPUT, errno, "%s", path);
        return add_problem(list, path, &problem, error);
    }
    if (!S_ISDIR(status.st_mode))
        return is_sidecar(path) ? add_entry(list, path, error)
                                : add_figure(list, path, true, error);
    size_t before = list->count, length = strlen(path);
    while (length > 1 && path[length - 1] == '/')
        length--;
    const char *folder = kiln_arena_text(list->arena, path, length);
    if (!folder)
        return kiln_error_no_memory(error, "the figures");
    if (!search(list, folder, 0, error) || list->count > before)
        return list->count > before;
    kiln_error_set(&problem, KILN_INVALID_INPUT,
                   "%s: no figures in the folder: none has a sidecar %s", path, KILN_RECORD_SUFFIX);
    return add_problem(list, path, &problem, error);
}

struct kiln_figure_list *kiln_figure_list_load(const char *const *paths, size_t count,
                                               struct kiln_error *error)
{
    struct kiln_figure_list *list = calloc(1, sizeof *list);
    struct kiln_arena *arena = kiln_arena_create();
    if (!list || !arena) {
        free(list);
        kiln_arena_destroy(&arena);
        kiln_error_no_memory(error, "the figures");
        return NULL;
    }
    list->arena = arena;
    bool ok = true;
    for (size_t i = 0; ok && i < count; i++)
        ok = add_path(list, paths[i], error);
    if (!ok)
        kiln_figure_list_destroy(&list);
    return list;
}

void kiln_figure_list_destroy(struct kiln_figure_list **list)
{
    if (!list || !*list)
        return;
    kiln_arena_destroy(&(*list)->arena);
    free(*list);
    *list = NULL;
}

size_t kiln_figure_list_count(const struct kiln_figure_list *list)
{
    return list->count;
}

struct kiln_figure_entry kiln_figure_list_entry(const struct kiln_figure_list *list, size_t index)
{
    return list->entries[index];
}
