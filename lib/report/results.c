/* A run is a list of tests in RESULTS/run.json, and a result of each in RESULTS/NAME. Shards of one
 * run, each from another machine, are put together here. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "output/temporary.h"
#include "report/report.h"
#include "scene/node.h"
#include "suite/suite.h"

/* Tests are listed in groups, since a list of a file that kiln reads ends at 1024 entries. */
enum { RUN_VERSION = 1, GROUP_SIZE = 1000, MAX_RUN_SIZE = 64 << 20 };

static bool out_of_memory(struct kiln_error *error)
{
    return kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for the results");
}

bool kiln_suite_write_run(const struct kiln_suite *suite, double total_s, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE], seconds[32];
    if (!kiln_path_join(path, suite->results_folder, "run.json", error))
        return false;
    kiln_text_from_double(seconds, total_s);
    struct kiln_text text = {0};
    kiln_text_add(&text, "{\n  \"kiln_run\": %d,\n  \"version\": \"%s\",\n  \"total_s\": %s,\n",
                  RUN_VERSION, KILN_VERSION, seconds);
    if (suite->shards > 0)
        kiln_text_add(&text, "  \"shard\": %u,\n  \"shards\": %u,\n  \"all_tests\": %zu,\n",
                      suite->shard, suite->shards, suite->all_count);
    kiln_text_add(&text, "  \"tests\": [");
    for (size_t i = 0; i < suite->count; i++) {
        const char *before = i == 0 ? "[\n    " : i % GROUP_SIZE ? ",\n    " : "], [\n    ";
        kiln_text_add(&text, "%s{\"name\": ", before);
        kiln_text_add_json(&text, suite->tests[i].full_name);
        kiln_text_add(&text, ", \"test\": ");
        kiln_text_add_json(&text, suite->tests[i].path);
        kiln_text_add(&text, "}");
    }
    kiln_text_add(&text, suite->count ? "]]\n}\n" : "]\n}\n");
    bool written = text.failed ? out_of_memory(error)
                               : kiln_temporary_write_file(path, text.data, text.length, error);
    kiln_text_free(&text);
    return written;
}

/* ---- Reading run.json --------------------------------------------------------------------- */

/* A test of a run, which a thousand others may surround. */
struct entry {
    struct kiln_result *result;
    const char *folder; /* of the result */
    const char *run;    /* the folder of the run */
};

struct loading {
    struct kiln_arena *arena;
    struct kiln_error *error;
    struct entry *entries;
    size_t count, capacity;
    struct kiln_report_shard *shards; /* with room for one of each run */
    size_t shard_count;
    double total_s;
};

/* A name becomes a folder below the run's: it must not lead anywhere else. */
static bool is_test_name(const char *name)
{
    for (const char *part = name;; part++) {
        size_t length = strcspn(part, "/");
        if (length == 0 || (part[0] == '.' && (length == 1 || (length == 2 && part[1] == '.'))))
            return false;
        part += length;
        if (*part == '\0')
            return strlen(name) < KILN_PATH_SIZE / 2;
    }
}

/* The text under a key of an object. */
static const char *text_of(const struct loading *loading, const struct kiln_node *node,
                           const char *key)
{
    const struct kiln_node *entry = kiln_node_entry(node, key);
    if (entry && entry->kind == KILN_NODE_SCALAR && entry->quoted)
        return entry->text;
    kiln_node_error(entry ? entry : node, loading->error, "%s: a text in quotes must be here", key);
    return NULL;
}

/* What stands for the result of a test that left none. */
static struct kiln_result *missing_result(const struct loading *loading, const char *name,
                                          const char *test)
{
    struct kiln_result *result = kiln_arena_alloc(loading->arena, 1, sizeof *result);
    if (result) {
        kiln_result_init(result, name);
        result->test = test;
        result->status = KILN_TEST_ERROR;
        result->code = KILN_DEVICE_FAILED;
        result->message = "left no result: it was not run, or its process ended early";
    }
    return result;
}

static bool grow(struct loading *loading)
{
    if (loading->count < loading->capacity)
        return true;
    size_t capacity = loading->capacity ? loading->capacity * 2 : 256;
    struct entry *entries = kiln_arena_alloc(loading->arena, capacity, sizeof *entries);
    if (!entries)
        return false;
    if (loading->count)
        memcpy(entries, loading->entries, loading->count * sizeof *entries);
    loading->entries = entries;
    loading->capacity = capacity;
    return true;
}

static bool load_test(struct loading *loading, const char *run, const struct kiln_node *node)
{
    struct kiln_error *error = loading->error;
    const char *name = text_of(loading, node, "name");
    const char *test = name ? text_of(loading, node, "test") : NULL;
    if (!test)
        return false;
    char quoted[64], path[KILN_PATH_SIZE], file[KILN_PATH_SIZE];
    kiln_node_quote(quoted, name);
    if (!is_test_name(name))
        return kiln_node_error(node, error, "'%s' is no name of a test", quoted);
    if (!kiln_path_join(path, run, name, error) ||
        !kiln_path_join(file, path, "result.json", error))
        return false;
    char *folder = kiln_arena_text(loading->arena, path, strlen(path));
    if (!folder || !grow(loading))
        return out_of_memory(error);
    bool exists = access(file, F_OK) == 0;
    struct kiln_result *result = exists ? kiln_result_read(loading->arena, folder, error)
                                        : missing_result(loading, name, test);
    if (!result)
        return exists ? false : out_of_memory(error);
    if (strcmp(result->name, name) != 0) {
        char found[64];
        kiln_node_quote(found, result->name);
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the result of '%s'; that of '%s' was to be here", file, found,
                              quoted);
    }
    loading->entries[loading->count++] = (struct entry){result, folder, run};
    return true;
}

static bool load_tests(struct loading *loading, const char *run, const struct kiln_node *root)
{
    const struct kiln_node *groups = kiln_node_entry(root, "tests");
    if (!groups || groups->kind != KILN_NODE_LIST)
        return kiln_node_error(groups ? groups : root, loading->error,
                               "tests: lists of tests must be here");
    for (const struct kiln_node *group = groups->first; group; group = group->next) {
        if (group->kind != KILN_NODE_LIST)
            return kiln_node_error(group, loading->error, "tests: a list of tests must be here");
        for (const struct kiln_node *node = group->first; node; node = node->next) {
            if (!load_test(loading, run, node))
                return false;
        }
    }
    return true;
}

static bool read_head(struct loading *loading, const struct kiln_node *root)
{
    const struct kiln_node *version = kiln_node_entry(root, "kiln_run");
    const struct kiln_node *seconds = kiln_node_entry(root, "total_s");
    uint64_t number = 0;
    if (!version)
        return kiln_node_error(root, loading->error,
                               "not the list of a run: \"kiln_run\" is missing");
    if (version->kind != KILN_NODE_SCALAR || !kiln_text_to_uint64(version->text, &number) ||
        number != RUN_VERSION)
        return kiln_node_error(version, loading->error,
                               "kiln_run: allowed is %d, which this version of kiln writes",
                               RUN_VERSION);
    double total_s = 0;
    if (!seconds || seconds->kind != KILN_NODE_SCALAR ||
        !kiln_text_to_double(seconds->text, &total_s))
        return kiln_node_error(seconds ? seconds : root, loading->error,
                               "total_s: a number of seconds must be here");
    loading->total_s += total_s;
    return true;
}

static bool read_count(const struct loading *loading, const struct kiln_node *root, const char *key,
                       uint64_t *count)
{
    const struct kiln_node *node = kiln_node_entry(root, key);
    return (node && node->kind == KILN_NODE_SCALAR && kiln_text_to_uint64(node->text, count) &&
            *count > 0 && *count <= UINT32_MAX) ||
           kiln_node_error(node ? node : root, loading->error, "%s: a number from 1 must be here",
                           key);
}

static bool read_shard(struct loading *loading, const struct kiln_node *root)
{
    struct kiln_report_shard *shard = &loading->shards[loading->shard_count];
    if (!kiln_node_entry(root, "shards"))
        return true;
    if (!read_count(loading, root, "shard", &shard->number) ||
        !read_count(loading, root, "shards", &shard->count) ||
        !read_count(loading, root, "all_tests", &shard->tests))
        return false;
    loading->shard_count++;
    return true;
}

static bool load_run(struct loading *loading, const char *folder)
{
    char path[KILN_PATH_SIZE];
    struct kiln_error *error = loading->error;
    if (!kiln_path_join(path, folder, "run.json", error))
        return false;
    size_t size = 0;
    char *text = kiln_text_file_read(path, "the list of a run", MAX_RUN_SIZE, &size, error);
    if (!text)
        return false;
    const struct kiln_origin origin = {.name = path, .has_lines = true};
    const struct kiln_node *root = NULL;
    if (strspn(text, " \t\r\n") == size)
        kiln_error_set(error, KILN_INVALID_INPUT, "%s: empty; the list of a run was to be here",
                       path);
    else
        root = kiln_node_parse(loading->arena, text, size, &origin, error);
    free(text);
    return root && read_head(loading, root) && read_shard(loading, root) &&
           load_tests(loading, folder, root);
}

/* ---- Results ------------------------------------------------------------------------------ */

static int by_name(const void *a, const void *b)
{
    const struct entry *x = a, *y = b;
    return strcmp(x->result->name, y->result->name);
}

static bool check_names(const struct loading *loading)
{
    for (size_t i = 1; i < loading->count; i++) {
        const struct entry *a = &loading->entries[i - 1], *b = &loading->entries[i];
        if (strcmp(a->result->name, b->result->name) == 0)
            return kiln_error_set(loading->error, KILN_INVALID_INPUT,
                                  "%s: there are two results, in %s and in %s; of a test, one "
                                  "shard alone may have one",
                                  a->result->name, a->run, b->run);
    }
    return true;
}

static struct kiln_results *collect(const struct loading *loading)
{
    struct kiln_results *results = kiln_arena_alloc(loading->arena, 1, sizeof *results);
    if (!results)
        return NULL;
    results->arena = loading->arena;
    results->count = loading->count;
    results->total_s = loading->total_s;
    results->shards = loading->shards;
    results->shard_count = loading->shard_count;
    results->started = "";
    results->tests = kiln_arena_alloc(loading->arena, loading->count + 1, sizeof *results->tests);
    results->folders =
        kiln_arena_alloc(loading->arena, loading->count + 1, sizeof *results->folders);
    if (!results->tests || !results->folders)
        return NULL;
    for (size_t i = 0; i < loading->count; i++) {
        struct kiln_result *result = loading->entries[i].result;
        results->tests[i] = result;
        results->folders[i] = loading->entries[i].folder;
        if (*result->started &&
            (!*results->started || strcmp(result->started, results->started) < 0))
            results->started = result->started;
    }
    return results;
}

struct kiln_results *kiln_results_load(const char *const *folders, size_t folder_count,
                                       struct kiln_error *error)
{
    struct loading loading = {.arena = kiln_arena_create(), .error = error};
    if (!loading.arena) {
        out_of_memory(error);
        return NULL;
    }
    loading.shards = kiln_arena_alloc(loading.arena, folder_count + 1, sizeof *loading.shards);
    bool ok = loading.shards != NULL;
    if (!ok)
        out_of_memory(error);
    for (size_t i = 0; ok && i < folder_count; i++)
        ok = load_run(&loading, folders[i]);
    if (ok && loading.count)
        qsort(loading.entries, loading.count, sizeof *loading.entries, by_name);
    struct kiln_results *results = NULL;
    if (ok && check_names(&loading)) {
        results = collect(&loading);
        if (!results)
            out_of_memory(error);
    }
    if (!results)
        kiln_arena_destroy(&loading.arena);
    return results;
}

void kiln_results_destroy(struct kiln_results **results)
{
    if (!*results)
        return;
    struct kiln_arena *arena = (*results)->arena; /* which holds the results, too */
    kiln_arena_destroy(&arena);
    *results = NULL;
}

/* Whether the shard of this number is there of the run that another shard is of. */
static bool has_shard(const struct kiln_results *results, const struct kiln_report_shard *of,
                      uint64_t number)
{
    for (size_t i = 0; i < results->shard_count; i++) {
        const struct kiln_report_shard *shard = &results->shards[i];
        if (shard->number == number && shard->count == of->count && shard->tests == of->tests)
            return true;
    }
    return false;
}

/* Tests of a shard that is missing were judged nowhere. */
static void find_missing_shard(const struct kiln_results *results,
                               struct kiln_results_summary *summary)
{
    for (size_t i = 0; i < results->shard_count && !summary->missing_shard; i++) {
        const struct kiln_report_shard *shard = &results->shards[i];
        uint64_t number = 1;
        while (number <= shard->count && has_shard(results, shard, number))
            number++;
        if (number <= shard->count) {
            summary->missing_shard = (uint32_t)number;
            summary->shards = (uint32_t)shard->count;
        }
    }
}

struct kiln_results_summary kiln_results_summary(const struct kiln_results *results)
{
    struct kiln_results_summary summary = {.tests = (uint32_t)results->count,
                                           .total_s = results->total_s};
    for (size_t i = 0; i < results->count; i++) {
        summary.counts[results->tests[i]->status]++;
        summary.code = kiln_code_worse(summary.code, results->tests[i]->code);
    }
    find_missing_shard(results, &summary);
    return summary;
}

const char *kiln_results_name(const struct kiln_results *results, size_t index)
{
    return results->tests[index]->name;
}
