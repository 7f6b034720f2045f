/* lib/suite/result*.c: result.json. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/text.h"
#include "suite/result_member.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

/* Whatever a scene, a driver or a crash may put into a text. */
static const char nasty[] = "a \"b\" \\ / 'c' # : , {} [] & * ! | > % @ ` \t\n\r\x01\x1f\x7f "
                            "\xc3\xa9 \xc2\x85\xc2\x80 \xe2\x80\xa8 \xef\xbb\xbf \xef\xbf\xbe "
                            "\xf0\x9f\x94\xa5";

/* Sets every member to a value of its own, so that two that are mixed up would be seen. */
static void fill(const struct kiln_member *members, void *object, uint32_t *next,
                 struct kiln_arena *arena)
{
    for (const struct kiln_member *m = members; m->name; m++) {
        void *value = (char *)object + m->offset;
        uint32_t number = ++*next;
        char text[256];
        snprintf(text, sizeof text,
                 m->kind == KILN_MEMBER_TEXT   ? "%u %s"
                 : m->kind == KILN_MEMBER_FILE ? "%u_%.0s"
                                               : "%u%.0s",
                 number, nasty);
        switch (m->kind) {
        case KILN_MEMBER_TEXT:
        case KILN_MEMBER_FILE:
        case KILN_MEMBER_HASH:
            *(const char **)value = kiln_arena_text(arena, text, strlen(text));
            break;
        case KILN_MEMBER_NAME:
            snprintf(value, KILN_METRIC_NAME_SIZE, "flip.p%u", number);
            break;
        case KILN_MEMBER_UINT32:
            *(uint32_t *)value = UINT32_MAX - number;
            break;
        case KILN_MEMBER_DOUBLE:
            *(double *)value = number % 3 ? 1.0 / number : (double)INFINITY;
            break;
        case KILN_MEMBER_BOOL:
            *(bool *)value = true;
            break;
        case KILN_MEMBER_CODE:
            *(enum kiln_code *)value = KILN_INTERRUPTED;
            break;
        case KILN_MEMBER_STATUS:
            *(enum kiln_test_status *)value =
                (enum kiln_test_status)(number % KILN_TEST_STATUS_COUNT);
            break;
        case KILN_MEMBER_JUDGED_BY:
            *(enum kiln_judged_by *)value = (enum kiln_judged_by)(1 + number % 3);
            break;
        case KILN_MEMBER_END:
            fail();
        }
    }
}

static void assert_member(const struct kiln_member *m, const char *a_object, const char *b_object)
{
    const void *a = a_object + m->offset, *b = b_object + m->offset;
    switch (m->kind) {
    case KILN_MEMBER_TEXT:
    case KILN_MEMBER_FILE:
    case KILN_MEMBER_HASH:
        assert_string_equal(*(const char *const *)a, *(const char *const *)b);
        break;
    case KILN_MEMBER_NAME:
        assert_string_equal(a, b);
        break;
    case KILN_MEMBER_DOUBLE:
        assert_true(*(const double *)a == *(const double *)b);
        break;
    case KILN_MEMBER_BOOL:
        assert_int_equal(*(const bool *)a, *(const bool *)b);
        break;
    default:
        assert_memory_equal(a, b, 4);
    }
}

static void assert_members(const struct kiln_member *members, const void *a, const void *b)
{
    for (const struct kiln_member *m = members; m->name; m++)
        assert_member(m, a, b);
}

enum { COLUMNS = 13 };

/* Returns a command with a word, quoted, after the folder of results. */
static const char *command_of(struct kiln_arena *arena, const char *start, const char *results,
                              const char *word)
{
    struct kiln_text text = {0};
    kiln_text_add(&text, "%s --results %s ", start, results);
    kiln_text_add_shell_word(&text, word);
    const char *command = kiln_arena_text(arena, text.data, text.length);
    kiln_text_free(&text);
    return command;
}

/* A result of so many frames, of which every second is measured, in a folder of results. */
static struct kiln_result full_result(struct kiln_arena *arena, uint32_t frames,
                                      const char *results)
{
    struct kiln_result result = {.column_count = COLUMNS, .change_count = 2, .note_count = 2};
    uint32_t next = 0;
    fill(kiln_result_members, &result, &next, arena);
    result.status = KILN_TEST_NEW;
    result.name = "effects/fire";
    result.test = kiln_arena_format(arena, "%s.yaml", result.test);
    result.rerun = command_of(arena, "kiln test", results, result.test);
    result.approve = command_of(arena, "kiln test approve", results, result.name);
    for (size_t i = 0; i < COLUMNS; i++)
        fill(kiln_result_column_members, &result.columns[i], &next, arena);
    result.frame_count = frames;
    result.frames = kiln_arena_alloc(arena, frames + 1, sizeof *result.frames);
    for (uint32_t i = 0; i < frames; i++) {
        struct kiln_result_frame *frame = &result.frames[i];
        fill(kiln_result_frame_members, frame, &next, arena);
        frame->number = i * 2;
        frame->measured = i % 2 == 0;
        if (!frame->measured)
            continue;
        fill(kiln_result_measured_members, frame, &next, arena);
        for (size_t c = 0; c < COLUMNS; c++) {
            frame->values[c] = c == 3 ? (double)INFINITY : 0.1 * (double)(next + c);
            frame->beyond[c] = c % 3 == 0;
        }
    }
    result.changes = kiln_arena_alloc(arena, 2, sizeof *result.changes);
    result.notes = kiln_arena_alloc(arena, 2, sizeof *result.notes);
    for (size_t i = 0; i < 2; i++) {
        fill(kiln_result_change_members, &result.changes[i], &next, arena);
        result.changes[i].place = i ? nasty : ""; /* in files only if it is known */
        result.notes[i] = i ? nasty : "";
    }
    return result;
}

static void assert_results(const struct kiln_result *a, const struct kiln_result *b)
{
    assert_members(kiln_result_members, a, b);
    assert_int_equal(a->column_count, b->column_count);
    for (size_t i = 0; i < a->column_count; i++)
        assert_members(kiln_result_column_members, &a->columns[i], &b->columns[i]);
    assert_int_equal(a->frame_count, b->frame_count);
    for (size_t i = 0; i < a->frame_count; i++) {
        const struct kiln_result_frame *f = &a->frames[i], *g = &b->frames[i];
        assert_members(kiln_result_frame_members, f, g);
        assert_members(kiln_result_measured_members, f, g);
        for (size_t c = 0; c < KILN_MAX_COLUMNS; c++)
            assert_true(f->values[c] == g->values[c] && f->beyond[c] == g->beyond[c]);
    }
    assert_int_equal(a->change_count, b->change_count);
    for (size_t i = 0; i < a->change_count; i++) {
        assert_members(kiln_result_change_members, &a->changes[i], &b->changes[i]);
        assert_string_equal(a->changes[i].place, b->changes[i].place);
    }
    assert_int_equal(a->note_count, b->note_count);
    for (size_t i = 0; i < a->note_count; i++)
        assert_string_equal(a->notes[i], b->notes[i]);
}

/* A result that is written is read as it was, in new folders, and over an older result. */
static void results_survive_the_file(void **state)
{
    (void)state;
    static const uint32_t frames[] = {3, 0, KILN_TEST_MAX_FRAMES};
    char folder[32], inner[64];
    test_make_folder(folder);
    snprintf(inner, sizeof inner, "%s/effects/fire", folder);
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        struct kiln_arena *arena = kiln_arena_create();
        struct kiln_result result = full_result(arena, frames[i], folder);
        struct kiln_error error = {0};
        assert_true(kiln_result_write(&result, inner, &error));
        struct kiln_result *back =
            kiln_result_read(arena, &(struct kiln_result_place){folder, "effects/fire"}, &error);
        if (!back)
            fail_msg("%s", error.message);
        else
            assert_results(&result, back);
        kiln_arena_destroy(&arena);
    }
    test_remove_folder(folder);
}

static void long_lists_are_cut_and_say_so(void **state)
{
    (void)state;
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_result result;
    kiln_result_init(&result, "a");
    result.change_count = result.note_count = 5000;
    result.changes = kiln_arena_alloc(arena, 5000, sizeof *result.changes);
    result.notes = kiln_arena_alloc(arena, 5000, sizeof *result.notes);
    for (size_t i = 0; i < 5000; i++) {
        result.changes[i] = (struct kiln_result_change){"key", "1", "2", ""};
        result.notes[i] = "note";
    }
    struct kiln_text text = {0};
    assert_true(kiln_result_print(&result, &text));
    struct kiln_error error = {0};
    struct kiln_result *back = kiln_result_parse(arena, text.data, text.length, "a", &error);
    if (!back)
        fail_msg("%s", error.message);
    assert_int_equal(back->change_count, KILN_RESULT_MAX_ENTRIES);
    assert_int_equal(back->note_count, KILN_RESULT_MAX_ENTRIES);
    assert_string_equal(back->changes[998].key, "key");
    assert_string_equal(back->changes[999].key, "and 4001 more");
    assert_string_equal(back->notes[999], "and 4001 more");
    kiln_text_free(&text);
    kiln_arena_destroy(&arena);
}

static void the_score_is_the_worst_measured(void **state)
{
    (void)state;
    struct kiln_result_frame frames[3] = {
        {.measured = true, .score = 0.5}, {.score = 9}, {.measured = true, .score = 0.75}};
    struct kiln_result result = {.frames = frames, .frame_count = 3};
    assert_true(kiln_result_score(&result) == 0.75);
    result.frame_count = 0;
    assert_true(kiln_result_score(&result) == 0);
}

/* ---- Broken files ------------------------------------------------------------------------- */

/* A good result's text with the first `from` replaced. */
static char *spoil(const char *good, const char *from, const char *to)
{
    const char *at = strstr(good, from);
    if (!at)
        fail_msg("%s is not there", from);
    char *text = malloc(strlen(good) + strlen(to) + 1);
    assert_non_null(text);
    sprintf(text, "%.*s%s%s", (int)(at - good), good, to, at + strlen(from));
    return text;
}

/* What is replaced in a good text, and what is said then. */
static const struct broken {
    const char *from, *to, *message;
} broken[] = {
    {"\"kiln_result\": 2", "\"kiln_result\": 3",
     "2:18: kiln_result: found 3; allowed is 2, which this version of kiln writes"},
    {"\"kiln_result\": 2,", "", "1:1: not the result of a test: \"kiln_result\" is missing"},
    {"\"scene\": \"\",", "", "1:1: scene is missing"},
    {"\"scene\": \"\"", "\"scene\": []", "5:12: scene: found a list; allowed is a text in quotes"},
    {"\"scene\": \"\"", "\"scene\": x", "5:12: scene: found x; allowed is a text in quotes"},
    {"\"scene\"", "\"scenery\": 1, \"scene\"", "1:1: found 36 members; allowed are 35"},
    {"\"scene\"", "\"name\": 1, \"scene\"", "5:3: duplicate key 'name' (first in line 3)"},
    {"\"status\": \"pass\"", "\"status\": \"god\"",
     "8:13: status: found \"god\"; allowed is pass, skip, warn, change, new, fail or error"},
    {"\"code\": 0", "\"code\": 8", "9:11: code: found 8; allowed is 0 to 7 or 130"},
    {"\"code\": 0", "\"code\": 1",
     "9:11: code: found 1; allowed is 0, because the status is not a failure"},
    {"\"status\": \"pass\"", "\"status\": \"new\"",
     "9:11: code: found 0; allowed is a number other than 0, because the status is a failure"},
    {"\"seed\": 0", "\"seed\": 4294967296",
     "20:11: seed: found 4294967296; allowed is a whole number from 0 to 4294967295"},
    {"\"seed\": 0", "\"seed\": \"0\"",
     "20:11: seed: found \"0\"; allowed is a whole number from 0 to 4294967295"},
    {"\"warn\": 0", "\"warn\": .nan",
     "29:11: warn: found .nan; allowed is a number, or null for infinity"},
    {"\"hdr\": false", "\"hdr\": no", "30:10: hdr: found no; allowed is true or false"},
    {"\"log\": \"\"", "\"log\": \"../../x\"",
     "11:10: log: found \"../../x\"; allowed is the name of a file in the folder of the result"},
    {"\"log\": \"\"", "\"log\": \"..\"",
     "11:10: log: found \"..\"; allowed is the name of a file in the folder of the result"},
    {"\"picture\": \"\"", "\"picture\": \"/etc/passwd\"",
     "36:87: picture: found \"/etc/passwd\"; allowed is the name of a file in the folder of the "
     "result"},
    {"\"judged_by\": \"nothing\"", "\"judged_by\": \"luck\"",
     "36:50: judged_by: found \"luck\"; allowed is nothing, state, pixels or metrics"},
    {"\"number\": 7", "\"number\": 5", "37:5: frame 5 comes after frame 5; frames must ascend"},
    {"\"columns\": [", "\"columns\": 5, \"x\": [",
     "33:14: columns: found 5; allowed is a list of at most 32 entries"},
    {"\"name\": \"psnr\"", "\"name\": \"a_name_that_is_much_too_long\"",
     "34:14: name: found \"a_name_that_is_much_too_long\"; allowed is a text of 1 to 23 bytes in "
     "quotes"},
    {"\"psnr\": null", "\"psnr\": \"null\"",
     "36:402: psnr: found \"null\"; allowed is a number, or null for infinity"},
    {"\"psnr\": null", "\"pnsr\": null", "36:393: metrics: psnr is missing"},
    {"\"psnr\": null", "\"psnr\": null, \"x\": 1", "36:393: found 2 members; allowed are 1"},
    {"\"beyond\": [\"psnr\"]", "\"beyond\": [\"ssim\"]",
     "36:420: beyond: found \"ssim\"; allowed is a metric of the columns"},
    {"\"beyond\": [\"psnr\"]", "\"beyond\": 1", "36:5: beyond: a list of metrics must be here"},
    {"\"measured\": true", "\"measured\": false", "36:5: found 24 members; allowed are 14"},
    {"\"picture\": \"\"", "\"picture\": \"a b\"",
     "36:87: picture: found \"a b\"; allowed is the name of a file in the folder of the result"},
    {"\"pixels\": \"\"", "\"pixels\": \"xyz\"",
     "36:184: pixels: found \"xyz\"; allowed is a hash of at most 64 digits of 0 to 9 and a to f"},
    {"\"rerun\": \"\"", "\"rerun\": \"sh\"",
     "31:12: rerun: found \"sh\"; allowed is the command that kiln test writes for this test"},
    {"\"approve\": \"\"", "\"approve\": \"kiln test approve b\"",
     "32:14: approve: found \"kiln test approve b\"; allowed is the command that kiln test writes "
     "for this test"},
    {"\"notes\": []", "\"notes\": [{}]",
     "39:13: notes: found an object; allowed is a text in quotes"},
    {"\"changes\": []", "\"changes\": [1]", "38:15: key is missing"},
    {"\"notes\"", "&a \"notes\"", "39:7: anchors and aliases are not allowed"},
    {"}\n", "}\n---\n", "41:1: a result has one document; a second one starts here"},
};

static void broken_results_are_refused_with_their_place(void **state)
{
    (void)state;
    struct kiln_result_frame frames[2];
    kiln_result_frame_init(&frames[0], 5);
    kiln_result_frame_init(&frames[1], 7);
    frames[0].measured = frames[0].beyond[0] = true;
    frames[0].values[0] = (double)INFINITY;
    struct kiln_result result;
    kiln_result_init(&result, "a");
    result.column_count = 1;
    result.columns[0] = (struct kiln_compare_column){.name = "psnr", .unit = "dB"};
    result.frame_count = 2;
    result.frames = frames;
    struct kiln_text good = {0};
    assert_true(kiln_result_print(&result, &good));
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_error error = {0};
    if (!kiln_result_parse(arena, good.data, good.length, "r.json", &error))
        fail_msg("%s", error.message);
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        char *text = spoil(good.data, broken[i].from, broken[i].to);
        assert_null(kiln_result_parse(arena, text, strlen(text), "r.json", &error));
        expect_error(&error, KILN_INVALID_INPUT, "r.json:%s", broken[i].message);
        free(text);
    }
    /* Cut off anywhere before the last brace. */
    for (size_t length = 0; length + 2 < good.length; length += 7) {
        char *text = strndup(good.data, length);
        assert_null(kiln_result_parse(arena, text, length, "r.json", &error));
        if (length == 0) {
            expect_error(&error, KILN_INVALID_INPUT,
                         "r.json: the file is empty; expected a result");
        } else { /* libfyaml says where and why */
            char *end;
            const unsigned long line = strtoul(error.message + strlen("r.json:"), &end, 10);
            const unsigned long column = *end ? strtoul(end + 1, NULL, 10) : 0;
            expect_error_around(&error, KILN_INVALID_INPUT, "",
                                "r.json:%lu:%lu: not valid YAML: ", line, column);
        }
        free(text);
    }
    kiln_text_free(&good);
    kiln_arena_destroy(&arena);
}

static void files_that_are_no_result(void **state)
{
    (void)state;
    char folder[32], inner[64], path[96];
    test_make_folder(folder);
    snprintf(inner, sizeof inner, "%s/a", folder);
    snprintf(path, sizeof path, "%s/result.json", inner);
    assert_int_equal(mkdir(inner, 0777), 0);
    const struct kiln_result_place place = {folder, "a"};
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_error error = {0};
    assert_null(kiln_result_read(arena, &place, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "%s: the result of a test cannot be opened: No such file or directory", path);

    assert_int_equal(mkdir(path, 0777), 0);
    assert_null(kiln_result_read(arena, &place, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "%s: the path is not a file but a folder; allowed are JSON files", path);
    struct kiln_result result;
    kiln_result_init(&result, "a");
    assert_false(kiln_result_write(&result, inner, &error));
    expect_error(&error, KILN_USAGE, "%s: a folder has this name", path);
    assert_int_equal(rmdir(path), 0);

    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs("{\"name\": \"\xff\"}", file);
    fclose(file);
    assert_null(kiln_result_read(arena, &place, &error));
    expect_error(&error, KILN_INVALID_INPUT, "%s:1:11: not a text: invalid UTF-8 (byte 0xff)",
                 path);
    assert_int_equal(truncate(path, 0), 0);
    assert_null(kiln_result_read(arena, &place, &error));
    expect_error(&error, KILN_INVALID_INPUT, "%s: the file is empty; expected a result", path);
    kiln_arena_destroy(&arena);
    test_remove_folder(folder);
}

static void the_worst_frame_is_that_of_the_worst_status(void **state)
{
    (void)state;
    struct kiln_result result;
    struct kiln_result_frame frames[4];
    kiln_result_init(&result, "a");
    assert_int_equal(kiln_result_worst_frame(&result), 0);
    result.frames = frames;
    result.frame_count = 4;
    for (uint32_t i = 0; i < 4; i++)
        kiln_result_frame_init(&frames[i], i);
    frames[1].measured = true;
    frames[1].score = 0.5;
    assert_int_equal(kiln_result_worst_frame(&result), 1);
    frames[2] = frames[1];
    frames[2].status = KILN_TEST_FAIL;
    assert_int_equal(kiln_result_worst_frame(&result), 2);
    frames[3].status = KILN_TEST_FAIL; /* of another size: no score says how bad that is */
    assert_int_equal(kiln_result_worst_frame(&result), 3);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_worst_frame_is_that_of_the_worst_status),
        cmocka_unit_test(results_survive_the_file),
        cmocka_unit_test(long_lists_are_cut_and_say_so),
        cmocka_unit_test(the_score_is_the_worst_measured),
        cmocka_unit_test(broken_results_are_refused_with_their_place),
        cmocka_unit_test(files_that_are_no_result),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
