/* Starts the result of a test, sums up a result in a few numbers, and writes the result of a test
 * whose process could not do so.
 *
 * `kiln test` (cmd/test.c) runs each test in a process of its own. In that process, run.c starts
 * the result here; calibrate.c starts one for `kiln test calibrate`. The process hands its result
 * to `kiln test` only as the file result.json, from which cmd/test.c reads the summary here, and
 * cmd/test_lines.c the notes. A process that crashed or ran too long has left no such file, so
 * cmd/test.c records the error here.
 *
 * kiln_result_start must not set anything that only a run can know. A result that was recorded for
 * an error must be one that result_read.c accepts, because the reports read it like any other. */
#include "suite/summary.h"

#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "suite/test_case.h"

/* Returns "" for NULL, since no text of a result is NULL. */
static const char *text_or_empty(const char *text)
{
    return text ? text : "";
}

/* Returns the present time in UTC, such as "2026-01-31T12:00:00Z", or "" where that fails. */
static const char *time_text(struct kiln_arena *arena)
{
    char text[32] = "";
    time_t now = time(NULL);
    struct tm parts;
    if (!gmtime_r(&now, &parts) || strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts) == 0)
        return "";
    return text_or_empty(kiln_arena_text(arena, text, strlen(text)));
}

/* Returns the name of the file that the test's process prints into, or "". */
static const char *find_log(const struct kiln_test *test)
{
    char path[KILN_PATH_SIZE];
    struct kiln_error ignored = {0};
    bool fits = kiln_path_join(path, test->results, "log.txt", &ignored);
    return fits && access(path, F_OK) == 0 ? "log.txt" : "";
}

struct kiln_result *kiln_result_start(struct kiln_arena *arena, const struct kiln_test *test)
{
    struct kiln_result *result = kiln_arena_alloc(arena, 1, sizeof *result);
    if (!result)
        return NULL;
    kiln_result_init(result, test->full_name);
    result->test = test->path;
    result->scene = text_or_empty(test->scene);
    result->about = text_or_empty(test->about);
    result->golden = text_or_empty(test->golden);
    result->log = find_log(test);
    result->version = KILN_VERSION;
    result->repeat = 1;
    result->started = time_text(arena);
    return result;
}

void kiln_summary_take(struct kiln_test_summary *summary, const struct kiln_result *result)
{
    *summary = (struct kiln_test_summary){
        .status = result->status,
        .code = result->code,
        .frames = (uint32_t)result->frame_count,
        .notes = (uint32_t)result->note_count,
        .score = kiln_result_score(result),
        .total_s = result->total_s,
    };
    snprintf(summary->name, sizeof summary->name, "%s", result->name);
    snprintf(summary->message, sizeof summary->message, "%s", result->message);
}

bool kiln_test_record_error(const struct kiln_suite *suite, size_t index, enum kiln_code code,
                            const char *message, double total_s, struct kiln_error *error)
{
    const struct kiln_test *test = &suite->tests[index];
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_result *result = arena ? kiln_result_start(arena, test) : NULL;
    bool ok = false;
    if (!result) {
        kiln_error_no_memory(error, "%s", test->path);
    } else {
        result->status = KILN_TEST_ERROR;
        result->code = code;
        result->message = message;
        result->total_s = total_s;
        const struct kiln_test_params params = kiln_test_defaults();
        struct kiln_test_case test_case = {
            .arena = arena, .suite = suite, .test = test, .params = &params, .result = result};
        result->rerun = kiln_test_case_rerun_command(&test_case);
        ok = kiln_result_write(result, test->results, error);
    }
    kiln_arena_destroy(&arena);
    return ok;
}

bool kiln_test_read_summary(const struct kiln_suite *suite, size_t index,
                            struct kiln_test_summary *summary, struct kiln_error *error)
{
    const struct kiln_test *test = &suite->tests[index];
    struct kiln_arena *arena = kiln_arena_create();
    const struct kiln_result_place place = {suite->results_folder, test->full_name};
    const struct kiln_result *result = arena ? kiln_result_read(arena, &place, error) : NULL;
    if (!arena)
        kiln_error_no_memory(error, "%s", test->path);
    if (result)
        kiln_summary_take(summary, result);
    kiln_arena_destroy(&arena);
    return result != NULL;
}

bool kiln_test_read_note(const struct kiln_suite *suite, size_t index, uint32_t note,
                         char text[KILN_MESSAGE_SIZE], struct kiln_error *error)
{
    const struct kiln_test *test = &suite->tests[index];
    struct kiln_arena *arena = kiln_arena_create();
    const struct kiln_result_place place = {suite->results_folder, test->full_name};
    const struct kiln_result *result = arena ? kiln_result_read(arena, &place, error) : NULL;
    if (!arena)
        kiln_error_no_memory(error, "%s", test->path);
    bool ok = result && note < result->note_count;
    if (ok)
        snprintf(text, KILN_MESSAGE_SIZE, "%s", result->notes[note]);
    else if (result)
        kiln_error_set(error, KILN_USAGE, "%s: there is no note %u; the result has %zu",
                       test->full_name, note, result->note_count);
    kiln_arena_destroy(&arena);
    return ok;
}
