/* This file lists the files that a scene reads as claims, so that a program does not overwrite them
 * with its output. It does so for a loaded scene, and for a scene file that is not loaded. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/error.h"
#include "base/file.h"
#include "kiln_program.h"
#include "option/include.h"
#include "scene/asset_path.h"

bool kiln_scene_add_file(struct kiln_scene *scene, const char *path, const char *what)
{
    struct kiln_scene_file *file = kiln_arena_alloc(scene->arena, 1, sizeof *file);
    if (!file)
        return false;
    *file = (struct kiln_scene_file){.path = path, .what = what, .next = scene->files};
    scene->files = file;
    return true;
}

bool kiln_scene_claim(const struct kiln_scene *scene, struct kiln_claims *claims,
                      struct kiln_error *error)
{
    for (const struct kiln_scene_file *file = scene->files; file; file = file->next) {
        if (!(file->status
                  ? kiln_claims_read_open(claims, file->path, file->what, file->status, error)
                  : kiln_claims_read(claims, file->path, file->what, error)))
            return false;
    }
    return true;
}

/* ---- without loading the scene --------------------------------------------------------------- */

struct search {
    const char
        *folder; /* folder of the file that is read, with its slash; "": the working folder */
    struct kiln_arena *arena;
    struct kiln_claims *claims;
    struct kiln_error *error;
    uint32_t depth;  /* of includes */
    uint32_t *files; /* counts the files that were read */
};

static bool claim_text(const struct search *s, const char *text)
{
    char path[KILN_PATH_SIZE];
    struct stat status;
    int length = snprintf(path, sizeof path, "%s%s", s->folder, text);
    if (!*text || *text == '/' || length >= (int)sizeof path || stat(path, &status) != 0 ||
        !S_ISREG(status.st_mode))
        return true;
    return kiln_claims_read(s->claims, path, "a file of a scene", s->error);
}

/* Claims the files named in a node and below it. The recursion is limited by KILN_NODE_MAX_DEPTH.
 */
static bool claim_node(const struct search *s, const struct kiln_node *node)
{
    if (node->kind == KILN_NODE_SCALAR)
        return claim_text(s, node->text);
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        if (!claim_node(s, entry))
            return false;
    }
    return true;
}

static bool claim_yaml(const struct search *s, const char *text);

/* Claims the files that the texts of a file name, which lie below its folder. */
static bool claim_contents(const struct search *outer, const char *path)
{
    struct kiln_error ignored = {0}; /* loading the scene reports it */
    struct search search = *outer;
    size_t size = 0;
    const char *slash = strrchr(path, '/');
    search.folder = kiln_arena_text(search.arena, path, slash ? (size_t)(slash + 1 - path) : 0);
    if (!search.folder)
        return kiln_error_no_memory(search.error, "%s", path);
    if (search.depth++ > KILN_INCLUDE_MAX_DEPTH || ++*search.files > 2 * KILN_INCLUDE_MAX_FILES)
        return true;
    char *text = kiln_text_file_read(path, "a scene", KILN_MAX_SCENE_SIZE, &size, &ignored);
    const bool ok = !text || claim_yaml(&search, text);
    free(text);
    return ok;
}

/* Claims the files that a file includes, and those that they name. */
static bool claim_includes(const struct search *s, const struct kiln_node *root)
{
    const struct kiln_node *include = kiln_node_entry(root, "include");
    const bool is_list = include && include->kind == KILN_NODE_LIST;
    for (const struct kiln_node *path = is_list ? include->first : include; path;
         path = is_list ? path->next : NULL) {
        const char *file = path->kind == KILN_NODE_SCALAR && *path->text != '/'
                               ? kiln_arena_format(s->arena, "%s%s", s->folder, path->text)
                               : NULL;
        if (file && !claim_contents(s, file))
            return false;
    }
    return true;
}

static bool claim_yaml(const struct search *s, const char *text)
{
    struct kiln_error ignored = {0};
    struct kiln_node_counts counts = {0};
    const struct kiln_origin origin = {.name = "a scene", .counts = &counts};
    const struct kiln_node *root = kiln_node_parse(s->arena, text, strlen(text), &origin, &ignored);
    return !root || (claim_node(s, root) && claim_includes(s, root));
}

bool kiln_scene_claim_file(const char *path, const char *const *overrides, size_t override_count,
                           struct kiln_claims *claims, struct kiln_error *error)
{
    const char *slash = strrchr(path, '/');
    uint32_t files = 0;
    struct kiln_arena *arena = kiln_arena_create();
    const char *folder =
        arena ? kiln_arena_text(arena, path, slash ? (size_t)(slash + 1 - path) : 0) : NULL;
    const struct search search = {folder, arena, claims, error, 0, &files};
    bool ok = folder ? kiln_claims_read(claims, path, "a scene", error)
                     : kiln_error_no_memory(error, "%s", path);
    ok = ok && claim_contents(&search, path);
    for (size_t i = 0; ok && i < override_count; i++) {
        const char *equals = strchr(overrides[i], '=');
        ok = !equals || claim_yaml(&search, equals + 1);
    }
    kiln_arena_destroy(&arena);
    return ok;
}
