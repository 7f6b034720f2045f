/* Finds goldens that no test uses. A test that is renamed or deleted leaves its goldens behind, and
 * nothing else tells that it is not run any more. */
#include "suite/unused.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_DEPTH = 32 };

static bool is_test(const struct kiln_suite *suite, const char *name)
{
    for (size_t i = 0; i < suite->count; i++) {
        if (strcmp(suite->tests[i].name, name) == 0)
            return true;
    }
    return false;
}

/* Returns whether a test of this name would lie in a searched folder. */
static bool is_searched(const struct kiln_suite *suite, const char *name)
{
    for (size_t i = 0; i < suite->name_prefix_count; i++) {
        if (strncmp(name, suite->name_prefixes[i], strlen(suite->name_prefixes[i])) == 0)
            return true;
    }
    return false;
}

static bool add(struct kiln_suite *suite, const char *path)
{
    if (suite->unused_count == suite->unused_capacity) {
        size_t capacity = suite->unused_capacity ? 2 * suite->unused_capacity : 16;
        const char **paths = kiln_arena_alloc(suite->arena, capacity, sizeof *paths);
        if (!paths)
            return false;
        if (suite->unused_count)
            memcpy(paths, suite->unused, suite->unused_count * sizeof *paths);
        suite->unused = paths;
        suite->unused_capacity = capacity;
    }
    suite->unused[suite->unused_count++] = path;
    return true;
}

/* Searches a folder for unused goldens. `name` is the name of the test whose goldens the folder
 * would have, "" for the folder of all goldens. */
static bool search(struct kiln_suite *suite, const char *folder, const char *name, int depth)
{
    struct dirent **entries = NULL;
    int count = depth < MAX_DEPTH ? scandir(folder, &entries, NULL, alphasort) : 0;
    bool ok = true;
    for (int i = 0; i < count; i++) {
        const char *entry = entries[i]->d_name;
        struct stat status;
        if (strcmp(entry, "expect.yaml") == 0 && *name && is_searched(suite, name) &&
            !is_test(suite, name))
            ok = ok && add(suite, folder);
        if (ok && *entry != '.') {
            const char *path = kiln_arena_format(suite->arena, "%s/%s", folder, entry);
            const char *below =
                kiln_arena_format(suite->arena, "%s%s%s", name, *name ? "/" : "", entry);
            ok = path && below;
            if (ok && lstat(path, &status) == 0 && S_ISDIR(status.st_mode))
                ok = search(suite, path, below, depth + 1);
        }
        free(entries[i]);
    }
    free(entries);
    return ok;
}

bool kiln_unused_find(struct kiln_suite *suite, const char *golden)
{
    return search(suite, golden, "", 0);
}
