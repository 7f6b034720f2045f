/* lib/base/json.c: the writer of JSON. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/json.h"
#include "support/cmocka.h"

/* A text and its writer. */
struct page {
    struct kiln_text text;
    struct kiln_json json;
};

static int set_up(void **state)
{
    static struct page page;
    page = (struct page){0};
    page.json = kiln_json_to_text(&page.text);
    *state = &page;
    return 0;
}

static int tear_down(void **state)
{
    struct page *page = *state;
    kiln_text_free(&page->text);
    return 0;
}

/* What was written since the last call, which is a whole document. */
static void check_document(struct page *page, const char *expected)
{
    assert_true(kiln_json_finish(&page->json));
    assert_non_null(page->text.data);
    assert_string_equal(page->text.data, expected);
    page->text.length = 0;
}

/* ---- Punctuation and lines ------------------------------------------------------------------ */

static void commas_stand_between_items_alone(void **state)
{
    struct page *page = *state;
    struct kiln_json *json = &page->json;
    kiln_json_begin_object(json, NULL);
    kiln_json_begin_array(json, "none");
    kiln_json_end(json);
    kiln_json_begin_array(json, "kinds");
    kiln_json_bool(json, NULL, true);
    kiln_json_bool(json, NULL, false);
    kiln_json_null(json, NULL);
    kiln_json_begin_object(json, NULL);
    kiln_json_end(json);
    kiln_json_raw(json, NULL, "1e3");
    kiln_json_end(json);
    kiln_json_begin_object(json, "a \"b\"");
    kiln_json_string(json, "text", "x");
    kiln_json_string(json, "nothing", NULL);
    kiln_json_end(json);
    kiln_json_key(json, "key");
    kiln_json_format(json, NULL, "%02u\n%s", 7u, "\"");
    kiln_json_key(json, "in");
    kiln_json_begin_array(json, NULL);
    kiln_json_end(json);
    kiln_json_pair(json, "size", 1280, 720);
    kiln_json_strings(json, "words", (const char *const[]){"a", "b"}, 2);
    kiln_json_strings(json, "no_words", NULL, 0);
    kiln_json_end(json);
    check_document(page, "{\"none\": [], \"kinds\": [true, false, null, {}, 1e3], "
                         "\"a \\\"b\\\"\": {\"text\": \"x\", \"nothing\": null}, "
                         "\"key\": \"07\\u000a\\\"\", \"in\": [], \"size\": [1280, 720], "
                         "\"words\": [\"a\", \"b\"], \"no_words\": []}\n");
}

/* The example of the header. */
static void lines_begin_where_the_caller_says(void **state)
{
    struct page *page = *state;
    struct kiln_json *json = &page->json;
    kiln_json_begin_object(json, NULL);
    kiln_json_indent_items(json, 2);
    kiln_json_string(json, "name", "campfire");
    kiln_json_begin_array(json, "frames");
    kiln_json_uint(json, NULL, 7);
    kiln_json_uint(json, NULL, 9);
    kiln_json_end(json);
    kiln_json_end_indented(json, 0);
    check_document(page, "{\n  \"name\": \"campfire\",\n  \"frames\": [7, 9]\n}\n");
}

static void each_level_has_its_own_lines(void **state)
{
    struct page *page = *state;
    struct kiln_json *json = &page->json;
    kiln_json_begin_object(json, NULL);
    kiln_json_indent_items(json, 0);
    kiln_json_begin_array(json, "hanging");
    kiln_json_indent_items(json, 3);
    kiln_json_begin_object(json, NULL);
    kiln_json_int(json, "a", 1);
    kiln_json_indent_next(json, 5);
    kiln_json_int(json, "b", 2);
    kiln_json_int(json, "c", 3);
    kiln_json_end(json);
    kiln_json_int(json, NULL, 4);
    kiln_json_end(json);
    kiln_json_begin_array(json, "empty");
    kiln_json_indent_items(json, 3);
    kiln_json_indent_next(json, 7);
    kiln_json_end_indented(json, 1);
    kiln_json_int(json, "d", 5);
    kiln_json_end_indented(json, 0);
    check_document(page, "{\n\"hanging\": [\n   {\"a\": 1,\n     \"b\": 2, \"c\": 3},\n   4],\n"
                         "\"empty\": [],\n\"d\": 5\n}\n");
}

static void documents_follow_each_other(void **state)
{
    struct page *page = *state;
    struct kiln_json *json = &page->json;
    kiln_json_begin_object(json, NULL);
    kiln_json_end(json);
    assert_true(kiln_json_finish(json));
    kiln_json_string(json, NULL, "b");
    assert_true(kiln_json_finish(json));
    kiln_json_begin_array(json, NULL);
    kiln_json_int(json, NULL, -1);
    kiln_json_end(json);
    check_document(page, "{}\n\"b\"\n[-1]\n");
}

/* ---- Strings -------------------------------------------------------------------------------- */

static void strings_are_escaped(void **state)
{
    struct page *page = *state;
    static const struct {
        const char *string, *expected;
    } cases[] = {
        {"", "\"\"\n"},
        {"/plain 'text'\xc3\xa9\xf0\x9f\x94\xa5", "\"/plain 'text'\xc3\xa9\xf0\x9f\x94\xa5\"\n"},
        {"a\"\\b", "\"a\\\"\\\\b\"\n"},
        {"\n\t\x01\x1f\x7f", "\"\\u000a\\u0009\\u0001\\u001f\\u007f\"\n"},
        {"<a> & b", "\"<a> & b\"\n"},
        /* No start, cut short (before more, and at the end), overlong, a surrogate, too large. */
        {"\xff \x80", "\"\\ufffd \\ufffd\"\n"},
        {"\xf0\x9f!", "\"\\ufffd\\ufffd!\"\n"},
        {"\xe2\x82", "\"\\ufffd\\ufffd\"\n"},
        {"\xc0\xaf", "\"\\ufffd\\ufffd\"\n"},
        {"\xed\xa0\x80", "\"\\ufffd\\ufffd\\ufffd\"\n"},
        {"\xf4\x90\x80\x80", "\"\\ufffd\\ufffd\\ufffd\\ufffd\"\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_json_string(&page->json, NULL, cases[i].string);
        check_document(page, cases[i].expected);
    }
}

static void scripts_cannot_be_ended(void **state)
{
    struct page *page = *state;
    struct kiln_json *json = &page->json;
    json->style = KILN_JSON_SCRIPT;
    kiln_json_begin_object(json, NULL);
    kiln_json_string(json, "<", "</script><!--\"\\&]]>");
    kiln_json_begin_array(json, "numbers");
    kiln_json_number(json, NULL, (double)INFINITY);
    kiln_json_number(json, NULL, -(double)INFINITY);
    kiln_json_rounded(json, NULL, (double)NAN, 3);
    kiln_json_number(json, NULL, 0.5);
    kiln_json_end(json);
    kiln_json_end(json);
    check_document(page, "{\"\\u003c\":\"\\u003c/script\\u003e\\u003c!--\\\"\\\\\\u0026]]\\u003e\","
                         "\"numbers\":[\"inf\",\"-inf\",\"nan\",0.5]}\n");
}

/* ---- Numbers -------------------------------------------------------------------------------- */

static void numbers_are_short_or_as_long_as_told(void **state)
{
    struct page *page = *state;
    struct kiln_json *json = &page->json;
    kiln_json_begin_array(json, NULL);
    kiln_json_int(json, NULL, INT64_MIN);
    kiln_json_uint(json, NULL, UINT64_MAX);
    kiln_json_number(json, NULL, 0.1);
    kiln_json_number(json, NULL, 1.0 / 3);
    kiln_json_number(json, NULL, -1e300);
    kiln_json_rounded(json, NULL, 1.0 / 3, 4);
    kiln_json_rounded(json, NULL, 12345678.9, 9);
    kiln_json_time(json, NULL, 61.0625);
    kiln_json_time(json, NULL, 0.0004);
    kiln_json_time(json, NULL, -1);
    kiln_json_end(json);
    check_document(page, "[-9223372036854775808, 18446744073709551615, 0.1, 0.3333333333333333, "
                         "-1e+300, 0.3333, 12345678.9, 61.063, 0.000, 0.000]\n");
}

static void what_is_no_number_is_null(void **state)
{
    struct page *page = *state;
    struct kiln_json *json = &page->json;
    kiln_json_begin_object(json, NULL);
    kiln_json_number(json, "a", (double)INFINITY);
    kiln_json_number(json, "b", (double)NAN);
    kiln_json_rounded(json, "c", -(double)INFINITY, 9);
    kiln_json_time(json, "d", (double)NAN);
    kiln_json_time(json, "e", (double)INFINITY);
    kiln_json_end(json);
    check_document(page, "{\"a\": null, \"b\": null, \"c\": null, \"d\": null, \"e\": null}\n");
}

/* ---- Failures ------------------------------------------------------------------------------- */

static void nothing_comes_after_a_failed_write(void **state)
{
    struct page *page = *state;
    struct kiln_json *json = &page->json;
    kiln_json_begin_array(json, NULL);
    kiln_json_string(json, NULL, "a");
    page->text.failed = true; /* as after an allocation that failed */
    kiln_json_string(json, NULL, "b");
    assert_true(json->failed);
    page->text.failed = false;
    kiln_json_string(json, NULL, "c");
    kiln_json_end(json);
    assert_false(kiln_json_finish(json));
    assert_string_equal(page->text.data, "[\"a\"");
    kiln_json_null(json, NULL);
    assert_false(kiln_json_finish(json));
}

static void a_full_disk_is_told_of(void **state)
{
    (void)state;
    FILE *full = fopen("/dev/full", "w");
    assert_non_null(full);
    setvbuf(full, NULL, _IONBF, 0);
    struct kiln_json json = kiln_json_to_file(full);
    kiln_json_string(&json, NULL, "a");
    assert_false(kiln_json_finish(&json));
    fclose(full);

    char written[32] = "";
    FILE *out = fmemopen(written, sizeof written, "w");
    assert_non_null(out);
    json = kiln_json_to_file(out);
    kiln_json_string(&json, NULL, "a\t\"b\"");
    assert_true(kiln_json_finish(&json));
    fclose(out);
    assert_string_equal(written, "\"a\\u0009\\\"b\\\"\"\n");
}

static void open_in_an_object(struct kiln_json *json)
{
    kiln_json_begin_object(json, NULL);
}

static void write_a_member_without_name(struct kiln_json *json)
{
    kiln_json_begin_object(json, NULL);
    kiln_json_int(json, NULL, 1);
    kiln_json_end(json);
}

static void write_an_entry_with_name(struct kiln_json *json)
{
    kiln_json_begin_array(json, NULL);
    kiln_json_int(json, "a", 1);
    kiln_json_end(json);
}

static void name_the_document(struct kiln_json *json)
{
    kiln_json_int(json, "a", 1);
}

static void name_a_value_twice(struct kiln_json *json)
{
    kiln_json_begin_object(json, NULL);
    kiln_json_key(json, "a");
    kiln_json_int(json, "a", 1);
    kiln_json_end(json);
}

static void end_after_a_key(struct kiln_json *json)
{
    kiln_json_begin_object(json, NULL);
    kiln_json_key(json, "a");
    kiln_json_end(json);
}

static void end_nothing(struct kiln_json *json)
{
    kiln_json_end(json);
}

static void write_two_documents(struct kiln_json *json)
{
    kiln_json_int(json, NULL, 1);
    kiln_json_int(json, NULL, 2);
}

static void go_too_deep(struct kiln_json *json)
{
    for (int i = 0; i <= KILN_JSON_MAX_DEPTH; i++)
        kiln_json_begin_array(json, NULL);
    for (int i = 0; i <= KILN_JSON_MAX_DEPTH; i++)
        kiln_json_end(json);
}

static void mistakes_of_the_caller_fail(void **state)
{
    (void)state;
    static void (*const mistakes[])(struct kiln_json *) = {
        open_in_an_object,  write_a_member_without_name,
        name_the_document,  write_an_entry_with_name,
        name_a_value_twice, end_after_a_key,
        end_nothing,        write_two_documents,
        go_too_deep,
    };
    for (size_t i = 0; i < sizeof mistakes / sizeof *mistakes; i++) {
        struct kiln_text text = {0};
        struct kiln_json json = kiln_json_to_text(&text);
        mistakes[i](&json);
        assert_false(kiln_json_finish(&json));
        kiln_text_free(&text);
    }
}

static void the_deepest_level_is_a_level(void **state)
{
    struct page *page = *state;
    char expected[2 * KILN_JSON_MAX_DEPTH + 2];
    for (int i = 0; i < KILN_JSON_MAX_DEPTH; i++)
        kiln_json_begin_array(&page->json, NULL);
    for (int i = 0; i < KILN_JSON_MAX_DEPTH; i++)
        kiln_json_end(&page->json);
    memset(expected, '[', KILN_JSON_MAX_DEPTH);
    memset(expected + KILN_JSON_MAX_DEPTH, ']', KILN_JSON_MAX_DEPTH);
    memcpy(expected + 2 * KILN_JSON_MAX_DEPTH, "\n", 2);
    check_document(page, expected);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(commas_stand_between_items_alone, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lines_begin_where_the_caller_says, set_up, tear_down),
        cmocka_unit_test_setup_teardown(each_level_has_its_own_lines, set_up, tear_down),
        cmocka_unit_test_setup_teardown(documents_follow_each_other, set_up, tear_down),
        cmocka_unit_test_setup_teardown(strings_are_escaped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(scripts_cannot_be_ended, set_up, tear_down),
        cmocka_unit_test_setup_teardown(numbers_are_short_or_as_long_as_told, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_no_number_is_null, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nothing_comes_after_a_failed_write, set_up, tear_down),
        cmocka_unit_test(a_full_disk_is_told_of),
        cmocka_unit_test(mistakes_of_the_caller_fail),
        cmocka_unit_test_setup_teardown(the_deepest_level_is_a_level, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("json", tests, NULL, NULL);
}
