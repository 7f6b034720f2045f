/* Checks that the scene of a test lies below the root of the suite. Test files may come from
 * strangers. A test could name any file as its scene, and an error message would show a part of
 * that file. */
#include "suite/root.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"

/* Resolves the links of a path, or those of its folder if the file is missing. Returns false if the
 * folder is missing, too. */
static bool find_real(const char *path, char real[PATH_MAX])
{
    char folder[PATH_MAX];
    if (realpath(path, real))
        return true;
    const char *slash = strrchr(path, '/');
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 1,
             slash ? path : ".");
    if (!realpath(folder, real))
        return false;
    const size_t length = strlen(real);
    return snprintf(real + length, PATH_MAX - length, "/%s", slash ? slash + 1 : path) <
           (int)(PATH_MAX - length);
}

/* Finds the root for a test outside the working directory: the folder among params->paths that
 * contains the test, or else the test's own folder. */
static void find_folder(const struct kiln_suite_params *params, const char *test,
                        char folder[PATH_MAX])
{
    for (size_t i = 0; i < params->path_count; i++) {
        if (realpath(params->paths[i], folder) && kiln_path_below(test, folder))
            return;
    }
    const char *slash = strrchr(test, '/');
    snprintf(folder, PATH_MAX, "%.*s", slash > test ? (int)(slash - test) : 1, test);
}

void kiln_suite_check_root(const struct kiln_suite_params *params, struct kiln_test *test)
{
    char path[PATH_MAX], scene[PATH_MAX], root[PATH_MAX];
    if (test->problem.code != KILN_OK || strcmp(test->path, test->scene) == 0 ||
        !realpath(test->path, path))
        return;
    const bool is_there = find_real(test->scene, scene);
    const bool found = realpath(params->asset_root ? params->asset_root : ".", root) != NULL;
    if (!params->asset_root && (!found || !kiln_path_below(path, root)))
        find_folder(params, path, root);
    if (!found && params->asset_root)
        kiln_error_set(&test->problem, KILN_INVALID_INPUT,
                       "%s: --asset-root %s: there is no such folder", test->path,
                       params->asset_root);
    else if (!is_there || !kiln_path_below(scene, root))
        kiln_error_set(&test->problem, KILN_INVALID_INPUT,
                       "%s: scene: '%s' is not below the root of the suite, %s (--asset-root)",
                       test->path, test->scene, root);
}
