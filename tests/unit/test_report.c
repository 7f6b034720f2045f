/* lib/report: runs put together, and the exact text of reports. What programs that read them say is
 * in tests/report. KILN_UPDATE_EXPECTED=1 writes the expected texts anew. */
#include <fcntl.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "report/text.h"
#include "suite/result_member.h"
#include "suite/suite.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"
#include "support/results.h"

/* A new folder as the working directory, so that paths in reports are always the same. */
static int enter_folder(void **state)
{
    static char folder[32];
    test_make_folder(folder);
    *state = folder;
    return chdir(folder);
}

static int leave_folder(void **state)
{
    test_remove_folder(*state);
    return chdir("/");
}

static void write_run(const char *folder, bool good)
{
    struct kiln_error error = {0};
    if (!test_write_run(folder, good, &error))
        fail_msg("%s", error.message);
}

static struct kiln_results *load(const char *const *folders, size_t count)
{
    struct kiln_error error = {0};
    struct kiln_results *results = kiln_results_load(folders, count, &error);
    if (!results)
        fail_msg("%s", error.message);
    return results;
}

static void assert_refused(const char *const *folders, size_t count, const char *message)
{
    struct kiln_error error = {0};
    assert_null(kiln_results_load(folders, count, &error));
    expect_error(&error, KILN_INVALID_INPUT, "%s", message);
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* The caller frees it. */
static char *read_text(const char *path)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = fopen(path, "rb"), *memory = open_memstream(&text, &size);
    assert_non_null(memory);
    for (int c; file && (c = fgetc(file)) != EOF;)
        fputc(c, memory);
    if (file)
        fclose(file);
    assert_int_equal(fclose(memory), 0);
    return text;
}

/* ---- Runs --------------------------------------------------------------------------------- */

static void a_run_is_summed_up(void **state)
{
    (void)state;
    static const char *const out[] = {"out"};
    write_run("out", false);
    struct kiln_results *results = load(out, 1);
    struct kiln_results_summary summary = kiln_results_summary(results);
    static const uint32_t counts[KILN_TEST_STATUS_COUNT] = {1, 1, 1, 1, 1, 2, 3};
    assert_int_equal(summary.tests, 10);
    assert_memory_equal(summary.counts, counts, sizeof counts);
    assert_int_equal(summary.code, KILN_DEVICE_FAILED);
    assert_true(summary.total_s == 12.3456);
    assert_string_equal(results->started, "2026-01-31T12:00:00Z");
    for (size_t i = 1; i < results->count; i++)
        assert_true(strcmp(results->tests[i - 1]->name, results->tests[i]->name) < 0);
    assert_string_equal(results->tests[7]->name, "lost");
    assert_int_equal(results->tests[7]->status, KILN_TEST_ERROR);
    assert_string_equal(results->folders[7], "out/lost");
    char text[256];
    kiln_report_text_summary(text, results);
    assert_string_equal(text, "10 tests: 1 pass, 1 skip, 1 warn, 1 change, 1 new, 2 fail, 3 error; "
                              "in 12.346 s");
    char *line = NULL;
    size_t size = 0;
    FILE *out_text = open_memstream(&line, &size);
    assert_true(kiln_write_frames(out_text, &summary));
    assert_int_equal(fclose(out_text), 0);
    assert_string_equal(line, "7 frames: 2 by pixels, 3 by metrics, 1 by state, 1 by nothing; "
                              "1 of tests that pin GL: 0 by pixels, 1 by metrics");
    free(line);
    kiln_results_destroy(&results);
    assert_null(results);
    kiln_results_destroy(&results);
}

static void an_empty_run_is_green(void **state)
{
    (void)state;
    char folder[] = "out";
    static const char *const out[] = {"out"};
    struct kiln_suite suite = {.results_folder = folder};
    struct kiln_error error = {0};
    assert_true(kiln_suite_begin(&suite, &error));
    assert_true(kiln_suite_write_run(&suite, 0, &error));
    struct kiln_results *results = load(out, 1);
    assert_int_equal(kiln_results_summary(results).tests, 0);
    assert_int_equal(kiln_results_summary(results).code, KILN_OK);
    kiln_results_destroy(&results);
}

/* More tests than a list of a file may have entries. */
static void large_runs_are_listed(void **state)
{
    (void)state;
    enum { COUNT = 2500 };
    static struct kiln_test tests[COUNT];
    static char names[COUNT][16];
    for (int i = 0; i < COUNT; i++) {
        snprintf(names[i], sizeof names[i], "test_%04d", i);
        tests[i].full_name = names[i];
        tests[i].path = "a.yaml";
    }
    char folder[] = "out";
    static const char *const out[] = {"out"};
    struct kiln_suite suite = {.results_folder = folder, .tests = tests, .count = COUNT};
    struct kiln_error error = {0};
    assert_true(kiln_suite_begin(&suite, &error));
    assert_true(kiln_suite_write_run(&suite, 1, &error));
    struct kiln_results *results = load(out, 1);
    assert_int_equal(results->count, COUNT);
    assert_string_equal(results->tests[COUNT - 1]->name, "test_2499");
    assert_int_equal(kiln_results_summary(results).counts[KILN_TEST_ERROR], COUNT);
    kiln_results_destroy(&results);
}

/* Gives OUT the one test NAME, without a result. */
static void write_shard(const char *out, const char *name)
{
    char folder[32];
    snprintf(folder, sizeof folder, "%s", out);
    struct kiln_test test = {.full_name = name, .path = "a.yaml"};
    struct kiln_suite suite = {.results_folder = folder, .tests = &test, .count = 1};
    struct kiln_error error = {0};
    char run[64];
    snprintf(run, sizeof run, "%s/run.json", out);
    unlink(run); /* which a test may have changed */
    assert_true(kiln_suite_begin(&suite, &error));
    assert_true(kiln_suite_write_run(&suite, 2, &error));
}

static void shards_are_put_together(void **state)
{
    (void)state;
    static const char *const shards[] = {"b", "a"}, *const twice[] = {"a", "b", "a"};
    write_run("a", true);
    write_shard("b", "alone");
    struct kiln_results *results = load(shards, 2);
    assert_int_equal(results->count, 4);
    assert_string_equal(results->tests[0]->name, "alone");
    assert_string_equal(results->folders[0], "b/alone");
    assert_string_equal(results->folders[1], "a/effects/fire");
    assert_true(kiln_results_summary(results).total_s == 2 + 12.3456);
    kiln_results_destroy(&results);

    assert_refused(twice, 3,
                   "effects/fire: there are two results, in a and in a; each test must have one "
                   "result of one shard");
    write_shard("b", "effects/smoke");
    assert_refused(shards, 2,
                   "effects/smoke: there are two results, in b and in a; each test must have one "
                   "result of one shard");
}

static void write_part(const char *out, const char *name, uint32_t shard, uint32_t shards,
                       size_t all_count)
{
    char folder[32];
    snprintf(folder, sizeof folder, "%s", out);
    struct kiln_test test = {.full_name = name, .path = "a.yaml"};
    struct kiln_suite suite = {.results_folder = folder,
                               .tests = &test,
                               .count = 1,
                               .shard = shard,
                               .shards = shards,
                               .all_count = all_count};
    struct kiln_error error = {0};
    char run[64];
    snprintf(run, sizeof run, "%s/run.json", out);
    unlink(run); /* which a test may have changed */
    assert_true(kiln_suite_begin(&suite, &error));
    assert_true(kiln_suite_write_run(&suite, 2, &error));
}

static void expect_missing(const char *const *folders, size_t count, uint32_t shard,
                           uint32_t shards)
{
    struct kiln_results *results = load(folders, count);
    const struct kiln_results_summary summary = kiln_results_summary(results);
    assert_int_equal(summary.missing_shard, shard);
    assert_int_equal(summary.shards, shards);
    kiln_results_destroy(&results);
}

/* A machine that was lost took its tests with it, and nothing else would tell. */
static void missing_shards_are_told(void **state)
{
    (void)state;
    static const char *const shards[] = {"c", "a", "b", "all"};
    write_part("a", "one", 1, 3, 3);
    write_part("b", "two", 2, 3, 3);
    write_part("c", "three", 3, 3, 3);
    write_shard("all", "alone");
    expect_missing(shards, 4, 0, 0);
    expect_missing(shards, 2, 2, 3);
    write_part("b", "two", 2, 3, 4); /* of other tests */
    expect_missing(shards, 3, 2, 3);
    write_part("a", "one", 1, UINT32_MAX, 3);
    expect_missing(shards + 1, 1, 2, UINT32_MAX);
}

/* Every report tells of them as of a test that broke, since that is what people look for; a shard's
 * own run does not. */
static void reports_tell_of_missing_shards(void **state)
{
    (void)state;
    static const struct {
        const char *format, *one, *several;
    } formats[] = {
        {"junit", "<testsuite name=\"shard 2 of 6\" tests=\"1\" failures=\"0\" errors=\"1\"",
         "type=\"invalid-input\" message=\"shards 4-6 of 6 are missing: their tests were judged "
         "nowhere\""},
        {"tap", "not ok 3 - shard 2 of 6\n", "not ok 4 - shards 4-6 of 6\n"},
        {"github",
         "::error title=Golden image test broke%3A shard 2 of 6::shard 2 of 6 is missing: its "
         "tests "
         "were judged nowhere\n",
         "::shards 4-6 of 6 are missing: their tests were judged nowhere\n"},
        {"json", "\"name\": \"shard 2 of 6\"", "\"name\": \"shards 4-6 of 6\""},
        {"html", "4 of 4 tests did not pass", "shards 4-6 of 6 are missing"},
    };
    static const char *const shards[] = {"c", "a"};
    struct kiln_error error = {0};
    write_part("a", "one", 1, 6, 9);
    write_part("c", "other", 3, 6, 9);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        const struct kiln_results_output output = {
            .format = formats[i].format, .path = "report", .overwrite = true};
        struct kiln_results *results = kiln_results_load_whole(shards, 2, &error);
        assert_non_null(results);
        const struct kiln_results_summary summary = kiln_results_summary(results);
        assert_int_equal(summary.tests, 4);
        assert_int_equal(summary.counts[KILN_TEST_ERROR], 4);
        assert_true(kiln_results_write(results, &output, &error));
        kiln_results_destroy(&results);
        char *text = read_text("report");
        assert_non_null(strstr(text, formats[i].one));
        assert_non_null(strstr(text, formats[i].several));
        free(text);

        results = load(shards, 2);
        assert_true(kiln_results_write(results, &output, &error));
        kiln_results_destroy(&results);
        text = read_text("report");
        assert_null(strstr(text, " of 6"));
        free(text);
    }
}

/* Runs of which nothing is missing have nothing added, and the exit code of the tests alone. */
static void whole_runs_are_left_alone(void **state)
{
    (void)state;
    static const char *const shards[] = {"b", "a"}, *const first[] = {"a"};
    struct kiln_error error = {0};
    write_run("a", true);
    struct kiln_results *results = kiln_results_load_whole(first, 1, &error);
    assert_non_null(results);
    assert_int_equal(kiln_results_summary(results).tests, 3);
    assert_int_equal(kiln_results_summary(results).code, KILN_OK);
    kiln_results_destroy(&results);
    write_part("a", "one", 1, 2, 2);
    write_part("b", "two", 2, 2, 2);
    results = kiln_results_load_whole(shards, 2, &error);
    assert_non_null(results);
    assert_int_equal(kiln_results_summary(results).tests, 2);
    kiln_results_destroy(&results);
}

static void broken_runs_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", "out/run.json: the file is empty; expected the list of a run"},
        {"[]", "out/run.json:1:1: not the list of a run: \"kiln_run\" is missing"},
        {"{\"kiln_run\": 2}",
         "out/run.json:1:14: kiln_run: allowed is 1, which this version of kiln writes"},
        {"{\"kiln_run\": 1}", "out/run.json:1:1: total_s: a number of seconds must be here"},
        {"{\"kiln_run\": 1, \"total_s\": []}",
         "out/run.json:1:28: total_s: a number of seconds must be here"},
        {"{\"kiln_run\": 1, \"total_s\": 1}",
         "out/run.json:1:1: tests: lists of tests must be here"},
        {"{\"kiln_run\": 1, \"total_s\": 1, \"shard\": 0, \"shards\": 1}",
         "out/run.json:1:40: shard: a number from 1 must be here"},
        {"{\"kiln_run\": 1, \"total_s\": 1, \"shard\": 3, \"shards\": 2, \"all_tests\": 4}",
         "out/run.json:1:40: shard: a number up to that of the shards must be here"},
        {"{\"kiln_run\": 1, \"total_s\": 1, \"tests\": [1]}",
         "out/run.json:1:41: tests: a list of tests must be here"},
        {"{\"kiln_run\": 1, \"total_s\": 1, \"tests\": [[1]]}",
         "out/run.json:1:42: name: a text in quotes must be here"},
        {"{\"kiln_run\": 1, \"total_s\": 1, \"tests\": [[{\"name\": \"a\"}]]}",
         "out/run.json:1:42: test: a text in quotes must be here"},
    };
    static const char *const out[] = {"out"}, *const nowhere[] = {"nowhere"};
    assert_refused(nowhere, 1, "nowhere/run.json: No such file or directory");
    assert_int_equal(mkdir("out", 0777), 0);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        write_text("out/run.json", cases[i].text);
        assert_refused(out, 1, cases[i].message);
    }
    static const char *const names[] = {"",     ".",    "..", "../x",  "a/../../x",
                                        "/etc", "a//b", "a/", "a/./b", "a/.."};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char message[64];
        write_shard("out", names[i]);
        snprintf(message, sizeof message, "out/run.json:6:5: '%s' is not the name of a test",
                 names[i]);
        assert_refused(out, 1, message);
    }
}

static void results_of_other_tests_are_refused(void **state)
{
    (void)state;
    static const char *const out[] = {"out"};
    write_run("out", true);
    assert_int_equal(rename("out/effects/fire/result.json", "out/effects/smoke/result.json"), 0);
    assert_refused(out, 1,
                   "out/effects/smoke/result.json: the file has the result of 'effects/fire', but "
                   "that of 'effects/smoke' is expected");
    write_text("out/effects/smoke/result.json", "{\"kiln_result\": 2}");
    assert_refused(out, 1, "out/effects/smoke/result.json:1:1: name is missing");
}

/* ---- Reports ------------------------------------------------------------------------------ */

static void reports_have_their_exact_text(void **state)
{
    (void)state;
    static const char *const formats[] = {"junit", "tap", "github"}, *const out[] = {"out"};
    write_run("out", false);
    struct kiln_results *results = load(out, 1);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        char path[KILN_PATH_SIZE];
        snprintf(path, sizeof path, "%s/tests/report/expected/%s", KILN_SOURCE_DIR, formats[i]);
        const char *update = getenv("KILN_UPDATE_EXPECTED");
        struct kiln_results_output output = {
            .format = formats[i], .path = "new/report", .overwrite = true};
        output.path = update ? path : output.path;
        struct kiln_error error = {0};
        if (!kiln_results_write(results, &output, &error))
            fail_msg("%s", error.message);
        char *found = read_text(output.path), *expected = read_text(path);
        assert_string_equal(found, expected);
        free(found);
        free(expected);
    }
    kiln_results_destroy(&results);
}

/* "device_name" is "deviceName" to a script. */
static void assert_has_members(const char *page, const struct kiln_member *members)
{
    for (const struct kiln_member *m = members; m->name; m++) {
        char key[64] = "\"";
        size_t length = 1;
        bool raise = false;
        for (const char *c = m->name; *c; c++) {
            if (*c != '_')
                key[length++] = (char)(raise ? *c - 'a' + 'A' : *c);
            raise = *c == '_';
        }
        snprintf(key + length, sizeof key - length, "\":");
        if (!strstr(page, key))
            fail_msg("the page has no %s", key);
    }
}

/* The page's scripts can show whatever is known of a result. */
static void pages_have_every_member(void **state)
{
    (void)state;
    static const char *const out[] = {"out"};
    write_run("out", false);
    struct kiln_results *results = load(out, 1);
    const struct kiln_results_output output = {.format = "html", .path = "page.html"};
    struct kiln_error error = {0};
    assert_true(kiln_results_write(results, &output, &error));
    char *page = read_text("page.html");
    assert_has_members(page, kiln_result_members);
    assert_has_members(page, kiln_result_column_members);
    assert_has_members(page, kiln_result_frame_members);
    assert_has_members(page, kiln_result_measured_members);
    free(page);
    kiln_results_destroy(&results);
}

/* Of very many frames that fail, some are told of; the others are counted. */
static void long_sequences_are_cut(void **state)
{
    (void)state;
    static struct kiln_result_frame frames[KILN_TEST_MAX_FRAMES];
    struct kiln_result result;
    kiln_result_init(&result, "long");
    result.status = KILN_TEST_FAIL;
    result.code = KILN_FRAME_FAILED;
    result.frames = frames;
    result.frame_count = KILN_TEST_MAX_FRAMES;
    for (uint32_t i = 0; i < KILN_TEST_MAX_FRAMES; i++) {
        kiln_result_frame_init(&frames[i], i);
        frames[i].status = KILN_TEST_FAIL;
        frames[i].picture = "picture.png";
    }
    struct kiln_error error = {0};
    write_shard("out", "long");
    assert_true(kiln_result_write(&result, "out/long", &error));
    static const char *const out[] = {"out"};
    struct kiln_results *results = load(out, 1);
    static const char *const formats[] = {"junit", "tap"};
    static const char *const cut[] = {"and 980 frames more\n", "  frames_left_out: 980\n"};
    for (size_t i = 0; i < 2; i++) {
        struct kiln_results_output output = {
            .format = formats[i], .path = "report", .overwrite = true};
        assert_true(kiln_results_write(results, &output, &error));
        char *text = read_text("report");
        assert_non_null(strstr(text, cut[i]));
        assert_true(strlen(text) < 10000);
        free(text);
    }
    kiln_results_destroy(&results);
}

/* A report is whole, or not there. */
static void reports_that_cannot_be_written(void **state)
{
    (void)state;
    static const char *const out[] = {"out"};
    write_run("out", true);
    struct kiln_results *results = load(out, 1);
    struct kiln_error error = {0};
    struct kiln_results_output output = {.format = "jnuit", .path = "report", .overwrite = true};
    assert_false(kiln_results_write(results, &output, &error));
    expect_error(&error, KILN_USAGE,
                 "'jnuit' is not a format of a report; there are junit, json, tap, github, html");
    assert_int_equal(access("report", F_OK), -1);

    output.format = "junit";
    output.path = "out";
    assert_false(kiln_results_write(results, &output, &error));
    expect_error(&error, KILN_USAGE, "out: a folder has this name");
    output.path = "out/run.json/report";
    assert_false(kiln_results_write(results, &output, &error));
    expect_error(
        &error, KILN_USAGE,
        "out/run.json: the path is not a folder, but out/run.json/report needs a folder here");

    int stdout_copy = dup(STDOUT_FILENO), full = open("/dev/full", O_WRONLY);
    assert_true(stdout_copy >= 0 && full >= 0);
    fflush(stdout);
    dup2(full, STDOUT_FILENO);
    output.path = "-";
    bool written = kiln_results_write(results, &output, &error);
    clearerr(stdout);
    dup2(stdout_copy, STDOUT_FILENO);
    close(full);
    close(stdout_copy);
    assert_false(written);
    expect_error(&error, KILN_IO,
                 "standard output: the report cannot be written: No space left on device");
    kiln_results_destroy(&results);
}

static void every_format_is_listed(void **state)
{
    (void)state;
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_true(kiln_write_reports(out));
    assert_int_equal(fclose(out), 0);
    static const char *const names[] = {"junit", "json", "tap", "github", "html"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        assert_non_null(strstr(text, names[i]));
    free(text);
}

static void numbers_are_short(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *text;
    } cases[] = {
        {0, "0"},           {0.01, "0.01"},    {0.0123456, "0.01235"}, {-1.5, "-1.5"},
        {123456, "123500"}, {INFINITY, "inf"}, {1e-7, "1e-07"},
    };
    char text[32];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_report_text_number(text, cases[i].value);
        assert_string_equal(text, cases[i].text);
    }
    kiln_report_text_seconds(text, 0.0004);
    assert_string_equal(text, "0.000");
    kiln_report_text_seconds(text, 61.9996);
    assert_string_equal(text, "62.000");
    kiln_report_text_seconds(text, -1);
    assert_string_equal(text, "0.000");
}

#define in_folder(function) cmocka_unit_test_setup_teardown(function, enter_folder, leave_folder)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        in_folder(a_run_is_summed_up),
        in_folder(an_empty_run_is_green),
        in_folder(large_runs_are_listed),
        in_folder(shards_are_put_together),
        in_folder(missing_shards_are_told),
        in_folder(reports_tell_of_missing_shards),
        in_folder(whole_runs_are_left_alone),
        in_folder(broken_runs_are_refused),
        in_folder(results_of_other_tests_are_refused),
        in_folder(reports_have_their_exact_text),
        in_folder(pages_have_every_member),
        in_folder(long_sequences_are_cut),
        in_folder(reports_that_cannot_be_written),
        cmocka_unit_test(every_format_is_listed),
        cmocka_unit_test(numbers_are_short),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
