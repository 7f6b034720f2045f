/* This file lists the files that a scene reads as claims, so that a program does not overwrite them
 * with its output. It does so for a loaded scene, and for a scene file that is not loaded. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/error.h"
#include "base/file.h"
#include "kiln_program.h"
#include "option/node.h"
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
    const char *folder; /* folder of the scene, with its slash; "": the working folder */
    struct kiln_claims *claims;
    struct kiln_error *error;
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

static bool claim_yaml(const struct search *s, struct kiln_arena *arena, const char *text)
{
    struct kiln_error ignored = {0}; /* loading the scene reports it */
    const struct kiln_origin origin = {.name = "a scene"};
    const struct kiln_node *root = kiln_node_parse(arena, text, strlen(text), &origin, &ignored);
    return !root || claim_node(s, root);
}

bool kiln_scene_claim_file(const char *path, const char *const *overrides, size_t override_count,
                           struct kiln_claims *claims, struct kiln_error *error)
{
    struct kiln_error ignored = {0};
    const char *slash = strrchr(path, '/');
    size_t size = 0;
    struct kiln_arena *arena = kiln_arena_create();
    const char *folder =
        arena ? kiln_arena_text(arena, path, slash ? (size_t)(slash + 1 - path) : 0) : NULL;
    const struct search search = {folder, claims, error};
    bool ok = folder ? kiln_claims_read(claims, path, "a scene", error)
                     : kiln_error_no_memory(error, "%s", path);
    char *text =
        ok ? kiln_text_file_read(path, "a scene", KILN_MAX_SCENE_SIZE, &size, &ignored) : NULL;
    ok = ok && (!text || claim_yaml(&search, arena, text));
    for (size_t i = 0; ok && i < override_count; i++) {
        const char *equals = strchr(overrides[i], '=');
        ok = !equals || claim_yaml(&search, arena, equals + 1);
    }
    free(text);
    kiln_arena_destroy(&arena);
    return ok;
}
