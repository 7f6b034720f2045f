/* Declares to kiln_claims which files a run of tests reads and writes, so that no output of the
 * command overwrites an input or another output. */
#include <dirent.h>
#include <stdlib.h>

#include "base/file.h"
#include "kiln_program.h"
#include "scene/scene.h"
#include "suite/results_folder.h"

/* Declares the files in the folder of a test's goldens as read; the folder may be missing. */
static bool claim_goldens(const struct kiln_test *test, struct kiln_claims *claims,
                          struct kiln_error *error)
{
    struct dirent **entries = NULL;
    int count = scandir(test->golden, &entries, NULL, NULL);
    bool ok = true;
    for (int i = 0; i < count; i++) {
        char path[KILN_PATH_SIZE];
        if (ok && entries[i]->d_name[0] != '.')
            ok = kiln_path_join(path, test->golden, entries[i]->d_name, error) &&
                 kiln_claims_read(claims, path, "a golden", error);
        free(entries[i]);
    }
    free(entries);
    return ok;
}

static bool claim_inputs(const struct kiln_test *test, struct kiln_claims *claims,
                         struct kiln_error *error)
{
    if (!kiln_claims_read(claims, test->path, "a test file", error) ||
        !claim_goldens(test, claims, error))
        return false;
    for (size_t i = 0; i < test->mask_count; i++) {
        if (test->masks[i].picture &&
            !kiln_claims_read(claims, test->masks[i].picture, "a mask", error))
            return false;
    }
    return !test->scene ||
           kiln_scene_claim_file(test->scene, test->overrides, test->override_count, claims, error);
}

static bool claim_result(const char *folder, const char *name, struct kiln_claims *claims,
                         struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    return kiln_path_join(path, folder, name, error) &&
           kiln_claims_write(claims, path, "the results", error);
}

bool kiln_suite_claim(const struct kiln_suite *suite, struct kiln_claims *claims,
                      struct kiln_error *error)
{
    bool ok = claim_result(suite->results_folder, "run.json", claims, error) &&
              claim_result(suite->results_folder, KILN_RESULTS_LIST, claims, error);
    for (size_t i = 0; ok && i < suite->count; i++) {
        const struct kiln_test *test = &suite->tests[i];
        ok = claim_inputs(test, claims, error) &&
             claim_result(test->results, "result.json", claims, error) &&
             claim_result(test->results, "log.txt", claims, error) &&
             claim_result(test->results, "against.txt", claims, error);
    }
    return ok;
}
