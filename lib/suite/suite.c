/* Loads a suite: finds the files of tests, reads and names them, and chooses the tests of a run. */
#include "suite/suite.h"

#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/error.h"
#include "base/text.h"
#include "option/node.h"
#include "suite/discover.h"
#include "suite/golden.h"
#include "suite/root.h"
#include "suite/test_file.h"
#include "suite/test_name.h"
#include "suite/unused.h"

enum { MAX_FULL_NAME = 255 }; /* struct kiln_test_summary has 256 bytes for a name and its end */

struct entry {
    struct kiln_found found;
    struct kiln_test_file file;
    bool dropped; /* a scene that belongs to a test file */
};

struct loader {
    const struct kiln_suite_params *params;
    struct kiln_suite *suite;
    struct kiln_error *error;
    struct entry *entries; /* ordered by name */
    size_t count;
};

static bool out_of_memory(struct loader *loader)
{
    return kiln_error_no_memory(loader->error, "reading tests");
}

/* ---- files ---------------------------------------------------------------------------------- */

static int by_name(const void *a, const void *b)
{
    const struct entry *x = a, *y = b;
    int order = strcmp(x->found.name, y->found.name);
    return order ? order : strcmp(x->found.path, y->found.path);
}

static bool read_files(struct loader *loader)
{
    struct kiln_arena *arena = loader->suite->arena;
    struct kiln_findings findings = {0};
    if (!kiln_discover(arena, loader->params, &findings, loader->error))
        return false;
    loader->suite->name_prefixes = findings.name_prefixes;
    loader->suite->name_prefix_count = findings.name_prefix_count;
    loader->entries = kiln_arena_alloc(arena, findings.count + 1, sizeof *loader->entries);
    if (!loader->entries)
        return out_of_memory(loader);
    for (; loader->count < findings.count; loader->count++) {
        struct entry *entry = &loader->entries[loader->count];
        entry->found = findings.items[loader->count];
        if (!kiln_test_file_read(arena, entry->found.path, &entry->file, loader->error))
            return false;
        kiln_suite_check_root(loader->params, &entry->file.test); /* may set its problem */
    }
    qsort(loader->entries, loader->count, sizeof *loader->entries, by_name);
    return true;
}

/* Drops each scene that was found in a folder and that a test file uses: the scene runs as the test
 * of that file. A scene x.yaml beside a faulty test file x.test.yaml is dropped, too, since the
 * file probably uses it. */
static void drop_named_scenes(struct loader *loader)
{
    for (size_t i = 0; i < loader->count; i++) {
        const struct entry *test_file = &loader->entries[i];
        struct stat scene, other;
        if (!kiln_test_file_is(test_file->found.path))
            continue;
        bool exists = stat(test_file->file.test.scene, &scene) == 0;
        bool faulty = test_file->file.test.problem.code != KILN_OK;
        for (size_t j = 0; j < loader->count; j++) {
            struct entry *entry = &loader->entries[j];
            if (!entry->found.in_folder || kiln_test_file_is(entry->found.path))
                continue;
            bool same = exists && stat(entry->found.path, &other) == 0 &&
                        scene.st_dev == other.st_dev && scene.st_ino == other.st_ino;
            if (same || (faulty && strcmp(entry->found.name, test_file->found.name) == 0))
                entry->dropped = true;
        }
    }
    size_t count = 0;
    for (size_t i = 0; i < loader->count; i++) {
        if (!loader->entries[i].dropped)
            loader->entries[count++] = loader->entries[i];
    }
    loader->count = count;
}

/* ---- names ---------------------------------------------------------------------------------- */

/* Gives a test with an invalid name a similar valid name, and sets the invalid name as the test's
 * problem. */
static bool sanitize_name(struct loader *loader, struct entry *entry)
{
    char quoted[64];
    kiln_node_quote(quoted, entry->found.name);
    kiln_error_set(&entry->file.test.problem, KILN_INVALID_INPUT,
                   "%s: '%s' cannot name a test: a name has up to %d bytes of letters, digits, "
                   "'.', '_' and '-', and does not start with '.' or '-'",
                   entry->found.path, quoted, KILN_TEST_MAX_NAME);
    entry->found.name = kiln_test_name_sanitize(loader->suite->arena, entry->found.name);
    return entry->found.name || out_of_memory(loader);
}

static bool check_names(struct loader *loader)
{
    for (size_t i = 0; i < loader->count; i++) {
        if (!kiln_test_name_is_valid(loader->entries[i].found.name) &&
            !sanitize_name(loader, &loader->entries[i]))
            return false;
    }
    qsort(loader->entries, loader->count, sizeof *loader->entries, by_name);
    for (size_t i = 1; i < loader->count; i++) {
        const struct kiln_found *found = &loader->entries[i].found;
        if (strcmp(found->name, loader->entries[i - 1].found.name) == 0)
            return kiln_error_set(loader->error, KILN_USAGE,
                                  "%s and %s: both tests are named '%s'; an empty file .kiln-tests "
                                  "in a folder above both lets names begin there",
                                  loader->entries[i - 1].found.path, found->path, found->name);
    }
    return true;
}

/* ---- tests ---------------------------------------------------------------------------------- */

/* Adds one test of an entry. If `device` is NULL, the test runs on the device that is chosen for
 * the run. A test on a device that its file lists is skipped where the device is missing. */
static bool add_test(struct loader *loader, const struct entry *entry, const char *device)
{
    struct kiln_suite *suite = loader->suite;
    struct kiln_test *test = &suite->tests[suite->count];
    *test = entry->file.test;
    test->name = test->full_name = entry->found.name;
    test->device = device;
    test->may_skip = device != NULL;
    if (entry->file.device_count > 1) {
        char name[KILN_DEVICE_NAME_SIZE];
        kiln_device_name(device, name);
        test->full_name = kiln_arena_format(suite->arena, "%s@%s", test->name, name);
    }
    if (!test->full_name)
        return out_of_memory(loader);
    if (strlen(test->full_name) > MAX_FULL_NAME)
        return kiln_error_set(
            loader->error, KILN_USAGE,
            "%s: the name of the test with its device, '%.40s...', is longer than %d bytes",
            test->path, test->full_name, MAX_FULL_NAME);
    test->results =
        kiln_arena_format(suite->arena, "%s/%s", suite->results_folder, test->full_name);
    test->golden = kiln_arena_format(suite->arena, "%s/%s", loader->params->golden, test->name);
    suite->count++;
    return (test->results && test->golden) || out_of_memory(loader);
}

static int by_full_name(const void *a, const void *b)
{
    return strcmp(((const struct kiln_test *)a)->full_name,
                  ((const struct kiln_test *)b)->full_name);
}

static bool make_tests(struct loader *loader)
{
    struct kiln_suite *suite = loader->suite;
    size_t total = 0;
    for (size_t i = 0; i < loader->count; i++)
        total += loader->entries[i].file.device_count + 1;
    suite->tests = kiln_arena_alloc(suite->arena, total + 1, sizeof *suite->tests);
    if (!suite->tests)
        return out_of_memory(loader);
    for (size_t i = 0; i < loader->count; i++) {
        const struct entry *entry = &loader->entries[i];
        if (entry->file.device_count == 0 && !add_test(loader, entry, NULL))
            return false;
        for (size_t d = 0; d < entry->file.device_count; d++) {
            if (!add_test(loader, entry, entry->file.devices[d]))
                return false;
        }
    }
    qsort(suite->tests, suite->count, sizeof *suite->tests, by_full_name);
    return true;
}

/* ---- choosing ------------------------------------------------------------------------------- */

/* Returns whether a test has a wanted name or fits it as a pattern. A name without a device means
 * the test on all devices. */
static bool has_name(const struct kiln_test *test, const char *wanted)
{
    return strcmp(wanted, test->full_name) == 0 || strcmp(wanted, test->name) == 0 ||
           fnmatch(wanted, test->full_name, 0) == 0 || fnmatch(wanted, test->name, 0) == 0;
}

static bool unknown_name(struct loader *loader, const char *name)
{
    const struct kiln_suite *suite = loader->suite;
    const char **names = kiln_arena_alloc(suite->arena, suite->count + 1, sizeof *names);
    if (!names)
        return out_of_memory(loader);
    for (size_t i = 0; i < suite->count; i++)
        names[i] = suite->tests[i].full_name;
    const char *nearest = kiln_text_nearest(name, names, suite->count);
    char quoted[64];
    kiln_node_quote(quoted, name);
    return kiln_error_set(loader->error, KILN_USAGE, "no test has the name '%s'%s%s%s", quoted,
                          nearest ? " (did you mean '" : "", nearest ? nearest : "",
                          nearest ? "'?)" : "; 'kiln test list' lists the tests");
}

static bool choose_names(struct loader *loader)
{
    const struct kiln_suite_params *params = loader->params;
    struct kiln_suite *suite = loader->suite;
    if (params->name_count == 0)
        return true;
    bool *chosen = kiln_arena_alloc(suite->arena, suite->count + 1, sizeof *chosen);
    if (!chosen)
        return out_of_memory(loader);
    for (size_t n = 0; n < params->name_count; n++) {
        bool any = false;
        for (size_t i = 0; i < suite->count; i++) {
            bool has = has_name(&suite->tests[i], params->names[n]);
            chosen[i] |= has;
            any |= has;
        }
        if (!any)
            return unknown_name(loader, params->names[n]);
    }
    size_t count = 0;
    for (size_t i = 0; i < suite->count; i++) {
        if (chosen[i])
            suite->tests[count++] = suite->tests[i];
    }
    suite->count = count;
    return true;
}

static void choose_shard(struct loader *loader)
{
    struct kiln_suite *suite = loader->suite;
    uint32_t shard = loader->params->shard, shards = loader->params->shards;
    size_t count = 0;
    suite->shard = shard;
    suite->shards = shards;
    suite->all_count = suite->count;
    for (size_t i = 0; i < suite->count; i++) {
        if (shards == 0 || i % shards == shard - 1)
            suite->tests[count++] = suite->tests[i];
    }
    suite->count = count;
}

/* ---- the suite ------------------------------------------------------------------------------ */

static bool check_params(const struct kiln_suite_params *params, struct kiln_error *error)
{
    if (params->path_count == 0)
        return kiln_error_set(error, KILN_USAGE, "no tests, scenes or folders are given");
    bool all = params->shard == 0 && params->shards == 0;
    return all || (params->shard >= 1 && params->shard <= params->shards) ||
           kiln_error_set(error, KILN_USAGE, "shard %u/%u: the first must be from 1 to the second",
                          params->shard, params->shards);
}

/* Checks that results and goldens have different folders: in one folder, each picture would become
 * the golden that it is judged by. */
static bool check_folders(const struct kiln_suite_params *params, struct kiln_error *error)
{
    struct stat golden, results;
    bool both_exist = stat(params->golden, &golden) == 0 && stat(params->results, &results) == 0;
    bool same = both_exist ? golden.st_dev == results.st_dev && golden.st_ino == results.st_ino
                           : strcmp(params->golden, params->results) == 0;
    return !same || kiln_error_set(error, KILN_USAGE,
                                   "%s: the folder of the results is also the folder of the "
                                   "goldens; results need a folder of their own",
                                   params->results);
}

/* Tidies a folder's path, which messages and the paths of files begin with: "out/" becomes "out",
 * and "" becomes ".". */
static char *tidy_folder(struct kiln_arena *arena, const char *folder)
{
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    return length ? kiln_arena_text(arena, folder, length) : kiln_arena_text(arena, ".", 1);
}

/* Returns whether the run covers all tests of the given folders, or one shard of them. Only then is
 * a golden without a test known to be unused. */
static bool is_whole(const struct kiln_suite_params *params)
{
    struct stat status;
    for (size_t i = 0; i < params->path_count; i++) {
        if (stat(params->paths[i], &status) != 0 || !S_ISDIR(status.st_mode))
            return false;
    }
    return params->name_count == 0;
}

static bool load(struct kiln_suite *suite, const struct kiln_suite_params *params,
                 struct kiln_error *error)
{
    struct kiln_suite_params tidied = *params;
    struct loader loader = {.params = &tidied, .suite = suite, .error = error};
    suite->results_folder = tidy_folder(suite->arena, params->results);
    tidied.golden = tidy_folder(suite->arena, params->golden);
    tidied.results = suite->results_folder;
    suite->is_found_by_name = params->path_count == 1 && strcmp(params->paths[0], ".") == 0;
    if (!tidied.golden || !tidied.results)
        return out_of_memory(&loader);
    if (!check_folders(&tidied, error) || !read_files(&loader))
        return false;
    drop_named_scenes(&loader);
    if (!check_names(&loader) || !make_tests(&loader))
        return false;
    if (is_whole(&tidied) && !kiln_unused_find(suite, tidied.golden))
        return out_of_memory(&loader);
    if (!choose_names(&loader))
        return false;
    choose_shard(&loader);
    return true;
}

struct kiln_suite *kiln_suite_load(const struct kiln_suite_params *params, struct kiln_error *error)
{
    if (!check_params(params, error))
        return NULL;
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_suite *suite = arena ? kiln_arena_alloc(arena, 1, sizeof *suite) : NULL;
    if (!suite)
        kiln_error_no_memory(error, "reading tests");
    else
        suite->arena = arena;
    if (suite && load(suite, params, error))
        return suite;
    kiln_arena_destroy(&arena);
    return NULL;
}

void kiln_suite_destroy(struct kiln_suite **suite)
{
    if (!suite || !*suite)
        return;
    struct kiln_arena *arena = (*suite)->arena; /* the arena holds the suite, too */
    kiln_arena_destroy(&arena);
    *suite = NULL;
}

size_t kiln_suite_count(const struct kiln_suite *suite)
{
    return suite->count;
}

struct kiln_test_info kiln_suite_test(const struct kiln_suite *suite, size_t index)
{
    const struct kiln_test *test = &suite->tests[index];
    return (struct kiln_test_info){.name = test->full_name,
                                   .path = test->path,
                                   .results = test->results,
                                   .time_limit_s = test->time_limit_s};
}

const char *const *kiln_suite_unused(const struct kiln_suite *suite, size_t *count)
{
    *count = suite->unused_count;
    return suite->unused;
}
