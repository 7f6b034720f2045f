/* Writes the list of a run's tests, RESULTS/run.json, and loads the results of runs: that list, and
 * the result of each test, RESULTS/NAME/result.json. It merges the shards of one run, which may
 * come from several machines, and finds shards that are missing. */
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/file_in.h"
#include "base/json.h"
#include "base/temporary.h"
#include "kiln_program.h"
#include "option/node.h"
#include "report/report.h"
#include "suite/results_folder.h"

/* Tests are listed in groups, since a list in a file that kiln reads may have at most 1024 entries.
 */
enum { RUN_VERSION = 1, GROUP_SIZE = 1000, MAX_RUN_SIZE = 64 << 20 };

static bool out_of_memory(struct kiln_error *error)
{
    return kiln_error_no_memory(error, "the results");
}

static void add_tests(struct kiln_json *json, const struct kiln_suite *suite)
{
    kiln_json_begin_array(json, "tests");
    for (size_t i = 0; i < suite->count; i++) {
        if (i % GROUP_SIZE == 0) {
            if (i > 0)
                kiln_json_end(json);
            kiln_json_begin_array(json, NULL);
            kiln_json_indent_items(json, 4);
        }
        kiln_json_begin_object(json, NULL);
        kiln_json_string(json, "name", suite->tests[i].full_name);
        kiln_json_string(json, "test", suite->tests[i].path);
        kiln_json_end(json);
    }
    if (suite->count > 0)
        kiln_json_end(json);
    kiln_json_end(json);
}

bool kiln_suite_write_run(const struct kiln_suite *suite, double total_s, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!kiln_path_join(path, suite->results_folder, "run.json", error))
        return false;
    struct kiln_text text = {0};
    struct kiln_json json = kiln_json_to_text(&text);
    kiln_json_begin_object(&json, NULL);
    kiln_json_indent_items(&json, 2);
    kiln_json_uint(&json, "kiln_run", RUN_VERSION);
    kiln_json_string(&json, "version", KILN_VERSION);
    kiln_json_number(&json, "total_s", total_s);
    if (suite->shards > 0) {
        kiln_json_uint(&json, "shard", suite->shard);
        kiln_json_uint(&json, "shards", suite->shards);
        kiln_json_uint(&json, "all_tests", suite->all_count);
    }
    add_tests(&json, suite);
    kiln_json_end_indented(&json, 0);
    bool written = kiln_json_finish(&json)
                       ? kiln_temporary_write_file(path, text.data, text.length, error)
                       : out_of_memory(error);
    kiln_text_free(&text);
    return written && kiln_results_folder_end(suite, error);
}

/* ---- Reading run.json --------------------------------------------------------------------- */

/* A test of a run that was loaded. */
struct entry {
    struct kiln_result *result;
    const char *folder; /* the result's folder */
    const char *run;    /* the folder of the run */
};

/* A run that was one of `count` shards, which have `tests` tests together. */
struct shard {
    uint64_t number, count, tests;
};

struct loading {
    struct kiln_arena *arena;
    struct kiln_error *error;
    struct entry *entries;
    size_t count, capacity;
    struct shard *shards; /* with room for one per run */
    size_t shard_count;
    uint32_t missing_shard, shard_total; /* first missing shard, number of shards; 0: none */
    double total_s;
};

/* Returns the text under a key of an object; NULL with an error. */
static const char *text_of(const struct loading *loading, const struct kiln_node *node,
                           const char *key)
{
    const struct kiln_node *entry = kiln_node_entry(node, key);
    if (entry && entry->kind == KILN_NODE_SCALAR && entry->quoted)
        return entry->text;
    kiln_node_error(entry ? entry : node, loading->error, "%s: a text in quotes must be here", key);
    return NULL;
}

/* Makes a result for a test that left none. */
static struct kiln_result *missing_result(const struct loading *loading, const char *name,
                                          const char *test)
{
    struct kiln_result *result = kiln_arena_alloc(loading->arena, 1, sizeof *result);
    if (result) {
        kiln_result_init(result, name);
        result->test = test;
        result->status = KILN_TEST_ERROR;
        result->code = KILN_DEVICE_FAILED;
        result->message = "no result: the test was not run, or its process ended early";
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

/* Returns whether there is a result, of whatever kind the file is. */
static bool exists(const struct kiln_result_place *place)
{
    char below[KILN_PATH_SIZE];
    struct kiln_error ignored = {0};
    if (!kiln_path_join(below, place->name, "result.json", &ignored))
        return true; /* kiln_result_read says what is wrong */
    const int file = kiln_file_open_below(place->results, below, O_PATH | O_NOFOLLOW | O_CLOEXEC);
    const bool is_missing = file < 0 && errno == ENOENT;
    if (file >= 0)
        close(file);
    return !is_missing;
}

static bool load_test(struct loading *loading, const char *run, const struct kiln_node *node)
{
    struct kiln_error *error = loading->error;
    const char *name = text_of(loading, node, "name");
    const char *test = name ? text_of(loading, node, "test") : NULL;
    if (!test)
        return false;
    char quoted[64], path[KILN_PATH_SIZE];
    kiln_node_quote(quoted, name);
    if (!kiln_result_name_is_valid(name))
        return kiln_node_error(node, error, "'%s' is not the name of a test", quoted);
    if (!kiln_path_join(path, run, name, error))
        return false;
    char *folder = kiln_arena_text(loading->arena, path, strlen(path));
    if (!folder || !grow(loading))
        return out_of_memory(error);
    const struct kiln_result_place place = {run, name};
    const bool is_there = exists(&place);
    struct kiln_result *result = is_there ? kiln_result_read(loading->arena, &place, error)
                                          : missing_result(loading, name, test);
    if (!result)
        return is_there ? false : out_of_memory(error);
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
    struct shard *shard = &loading->shards[loading->shard_count];
    if (!kiln_node_entry(root, "shards"))
        return true;
    if (!read_count(loading, root, "shard", &shard->number) ||
        !read_count(loading, root, "shards", &shard->count) ||
        !read_count(loading, root, "all_tests", &shard->tests))
        return false;
    if (shard->number > shard->count)
        return kiln_node_error(kiln_node_entry(root, "shard"), loading->error,
                               "shard: a number up to that of the shards must be here");
    loading->shard_count++;
    return true;
}

static bool load_run(struct loading *loading, const char *folder)
{
    char path[KILN_PATH_SIZE];
    struct kiln_error *error = loading->error;
    if (!kiln_path_join(path, folder, "run.json", error))
        return false;
    const int file = kiln_file_open_below(folder, "run.json", KILN_FILE_FLAGS | O_NOFOLLOW);
    if (file < 0)
        return errno == EXDEV || errno == ELOOP
                   ? kiln_error_set(error, KILN_INVALID_INPUT,
                                    "%s: the path is a link; allowed is a plain file", path)
                   : kiln_error_set_errno(error, KILN_INVALID_INPUT, errno, "%s", path);
    size_t size = 0;
    char *text =
        kiln_text_file_take(file, path, "the list of a run", MAX_RUN_SIZE, &size, NULL, error);
    close(file);
    if (!text)
        return false;
    const struct kiln_origin origin = {
        .name = path, .has_lines = true, .kind = "the list of a run"};
    const struct kiln_node *root = kiln_node_parse(loading->arena, text, size, &origin, error);
    free(text);
    return root && read_head(loading, root) && read_shard(loading, root) &&
           load_tests(loading, folder, root);
}

/* ---- Missing shards ----------------------------------------------------------------------- */

static int compare_counts(uint64_t a, uint64_t b)
{
    return (a > b) - (a < b);
}

/* Orders shards so that those of one run lie side by side. */
static int by_run(const void *a, const void *b)
{
    const struct shard *x = a, *y = b;
    if (x->tests != y->tests)
        return compare_counts(x->tests, y->tests);
    if (x->count != y->count)
        return compare_counts(x->count, y->count);
    return compare_counts(x->number, y->number);
}

/* Adds one result, an error, for the missing shards `first` to `last`, whose tests were judged
 * nowhere. */
static bool add_missing(struct loading *loading, uint64_t first, uint64_t last, uint64_t count)
{
    char name[64], message[128], range[32] = "";
    bool one = first == last;
    if (!one)
        snprintf(range, sizeof range, "-%" PRIu64, last);
    snprintf(name, sizeof name, "shard%s %" PRIu64 "%s of %" PRIu64, one ? "" : "s", first, range,
             count);
    snprintf(message, sizeof message, "%s %s missing: %s tests were judged nowhere", name,
             one ? "is" : "are", one ? "its" : "their");
    struct kiln_result *result = kiln_arena_alloc(loading->arena, 1, sizeof *result);
    const char *name_copy = kiln_arena_text(loading->arena, name, strlen(name));
    const char *message_copy = kiln_arena_text(loading->arena, message, strlen(message));
    if (!result || !name_copy || !message_copy || !grow(loading))
        return out_of_memory(loading->error);
    kiln_result_init(result, name_copy);
    result->status = KILN_TEST_ERROR;
    result->code = KILN_INVALID_INPUT;
    result->message = message_copy;
    loading->entries[loading->count++] = (struct entry){result, "", ""};
    return true;
}

/* Finds gaps in the numbers of each run's shards. If `add_results` is true, it adds a result for
 * each gap. */
static bool find_missing(struct loading *loading, bool add_results)
{
    struct shard *shards = loading->shards;
    if (loading->shard_count)
        qsort(shards, loading->shard_count, sizeof *shards, by_run);
    uint64_t expected = 1; /* the next number */
    for (size_t i = 0; i < loading->shard_count; i++) {
        const struct shard *shard = &shards[i], *next = shard + 1;
        bool last = i + 1 == loading->shard_count || next->count != shard->count ||
                    next->tests != shard->tests;
        const uint64_t gaps[2][2] = {{expected, shard->number - 1},
                                     {shard->number + 1, last ? shard->count : 0}};
        for (int g = 0; g < 2; g++) {
            if (gaps[g][0] > gaps[g][1])
                continue;
            if (loading->missing_shard == 0) {
                loading->missing_shard = (uint32_t)gaps[g][0];
                loading->shard_total = (uint32_t)shard->count;
            }
            if (add_results && !add_missing(loading, gaps[g][0], gaps[g][1], shard->count))
                return false;
        }
        expected = last ? 1 : shard->number + 1;
    }
    return true;
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
                                  "%s: there are two results, in %s and in %s; each test must have "
                                  "one result of one shard",
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
    results->missing_shard = loading->missing_shard;
    results->shards = loading->shard_total;
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

static void sort(const struct loading *loading)
{
    if (loading->count)
        qsort(loading->entries, loading->count, sizeof *loading->entries, by_name);
}

static bool load_runs(struct loading *loading, const char *const *folders, size_t folder_count,
                      bool report_missing)
{
    loading->shards = kiln_arena_alloc(loading->arena, folder_count + 1, sizeof *loading->shards);
    if (!loading->shards)
        return out_of_memory(loading->error);
    for (size_t i = 0; i < folder_count; i++) {
        if (!load_run(loading, folders[i]))
            return false;
    }
    sort(loading);
    if (!check_names(loading) || !find_missing(loading, report_missing))
        return false;
    sort(loading);
    return true;
}

static struct kiln_results *load(const char *const *folders, size_t folder_count,
                                 bool report_missing, struct kiln_error *error)
{
    struct loading loading = {.arena = kiln_arena_create(), .error = error};
    if (!loading.arena) {
        out_of_memory(error);
        return NULL;
    }
    struct kiln_results *results = NULL;
    if (load_runs(&loading, folders, folder_count, report_missing)) {
        results = collect(&loading);
        if (!results)
            out_of_memory(error);
    }
    if (!results)
        kiln_arena_destroy(&loading.arena);
    return results;
}

struct kiln_results *kiln_results_load(const char *const *folders, size_t folder_count,
                                       struct kiln_error *error)
{
    return load(folders, folder_count, false, error);
}

struct kiln_results *kiln_results_load_whole(const char *const *folders, size_t folder_count,
                                             struct kiln_error *error)
{
    return load(folders, folder_count, true, error);
}

void kiln_results_destroy(struct kiln_results **results)
{
    if (!results || !*results)
        return;
    struct kiln_arena *arena = (*results)->arena; /* the arena holds the results, too */
    kiln_arena_destroy(&arena);
    *results = NULL;
}

static void count_frames(const struct kiln_result *result, struct kiln_results_summary *summary)
{
    struct kiln_results_frames *frames = result->pins_gl ? &summary->gl_frames : &summary->frames;
    frames->all += (uint32_t)result->frame_count;
    for (size_t i = 0; i < result->frame_count; i++) {
        frames->by_pixels += result->frames[i].judged_by == KILN_JUDGED_BY_PIXELS;
        frames->by_metrics += result->frames[i].judged_by == KILN_JUDGED_BY_METRICS;
        frames->by_state += result->frames[i].judged_by == KILN_JUDGED_BY_STATE;
    }
}

struct kiln_results_summary kiln_results_summary(const struct kiln_results *results)
{
    struct kiln_results_summary summary = {.tests = (uint32_t)results->count,
                                           .total_s = results->total_s,
                                           .missing_shard = results->missing_shard,
                                           .shards = results->shards};
    for (size_t i = 0; i < results->count; i++) {
        summary.counts[results->tests[i]->status]++;
        count_frames(results->tests[i], &summary);
        summary.code = kiln_code_worse(summary.code, results->tests[i]->code);
    }
    return summary;
}

struct kiln_result_place kiln_results_place(const struct kiln_results *results, size_t test)
{
    const char *folder = results->folders[test], *name = results->tests[test]->name;
    const size_t length = strlen(folder), own = strlen(name);
    struct kiln_result_place place = {"", name};
    if (length > own + 1 && folder[length - own - 1] == '/' &&
        strcmp(folder + length - own, name) == 0)
        place.results = kiln_arena_text(results->arena, folder, length - own - 1);
    return place;
}

const char *kiln_results_name(const struct kiln_results *results, size_t index)
{
    return results->tests[index]->name;
}

static bool claim_result(const struct kiln_result *result, const char *folder,
                         struct kiln_claims *claims, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!kiln_path_join(path, folder, "result.json", error) ||
        !kiln_claims_read(claims, path, "a result", error))
        return false;
    for (size_t i = 0; i < result->frame_count; i++) {
        const char *picture = result->frames[i].picture;
        if (*picture && (!kiln_path_join(path, folder, picture, error) ||
                         !kiln_claims_read(claims, path, "a picture of a result", error)))
            return false;
    }
    return true;
}

bool kiln_results_claim_inputs(const struct kiln_results *results, const char *const *folders,
                               size_t folder_count, struct kiln_claims *claims,
                               struct kiln_error *error)
{
    for (size_t i = 0; i < folder_count; i++) {
        char path[KILN_PATH_SIZE];
        if (!kiln_path_join(path, folders[i], "run.json", error) ||
            !kiln_claims_read(claims, path, "a run", error))
            return false;
    }
    for (size_t i = 0; i < results->count; i++) {
        if (!claim_result(results->tests[i], results->folders[i], claims, error))
            return false;
    }
    return true;
}
