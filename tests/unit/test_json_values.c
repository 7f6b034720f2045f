/* If this fails, kiln-decode misreads the JSON of glTF files, or takes text that is no JSON. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "json.h"
#include "support/cmocka.h"
#include "support/errors.h"

static struct json read_text(const char *text)
{
    struct kiln_error error = {0};
    struct json json;
    if (!json_init(&json, text, strlen(text), &error))
        fail_msg("%s", error.message);
    return json;
}

static void refuse(const char *text, const char *message)
{
    struct kiln_error error = {0};
    struct json json;
    assert_false(json_init(&json, text, strlen(text), &error));
    expect_error(&error, KILN_INVALID_INPUT, "%s", message);
    json_finish(&json);
}

static void values_are_found(void **state)
{
    (void)state;
    struct json json =
        read_text("\xef\xbb\xbf {\"a\": [1, {\"b\": [[], {}]}, \"x\"],\n \"c\": {\"d\": true}, "
                  "\"a\\u0062\": 7, \"c\": {\"d\": false}} ");
    const uint32_t list = json_member(&json, 0, "a");
    uint32_t index = 0;
    assert_int_equal(json_count(&json, list), 3);
    uint32_t value = json_first(&json, list);
    assert_true(json_index(&json, value, &index) && index == 1);
    value = json_after(&json, list, value);
    assert_true(json_is_object(&json, value));
    assert_int_equal(json_count(&json, json_member(&json, value, "b")), 2);
    value = json_after(&json, list, value);
    assert_true(json_is(&json, value, "x"));
    assert_int_equal(json_after(&json, list, value), JSON_NONE);
    /* the second of two members of one name counts, and names may be escaped */
    const uint32_t twice = json_member(&json, 0, "c");
    assert_false(json_is_true(&json, json_member(&json, twice, "d")));
    assert_true(json_index(&json, json_member(&json, 0, "ab"), &index) && index == 7);
    assert_int_equal(json_member(&json, 0, "b"), JSON_NONE);
    assert_int_equal(json_member(&json, list, "b"), JSON_NONE);
    assert_int_equal(json_member(&json, JSON_NONE, "b"), JSON_NONE);
    assert_int_equal(json_first(&json, JSON_NONE), JSON_NONE);
    json_finish(&json);
}

static void numbers_are_read(void **state)
{
    (void)state;
    struct json json =
        read_text("[0, -0.5, 1e3, 1E-2, 4294967294, 4294967295, 1.5, -1, 1e400, \"1\"]");
    static const double expected[] = {0.0,          -0.5,         1000.0, 0.01,
                                      4294967294.0, 4294967295.0, 1.5,    -1.0};
    static const bool is_index[] = {true, false, true, false, true, false, false, false};
    uint32_t value = json_first(&json, 0), index = 0;
    double number = 0.0;
    for (size_t i = 0; i < 8; i++) {
        assert_true(json_number(&json, value, &number) && number == expected[i]);
        assert_int_equal(json_index(&json, value, &index), is_index[i]);
        value = json_after(&json, 0, value);
    }
    assert_false(json_number(&json, value, &number)); /* no finite number */
    assert_false(json_number(&json, json_after(&json, 0, value), &number));
    json_finish(&json);
}

static void texts_are_decoded(void **state)
{
    (void)state;
    struct json json =
        read_text("[\"\\u00e4\\ud83d\\ude00\\n\\/\", \"\\ud800x\", \"a\\u0000z\", \"\\uzzzz\"]");
    static const char *const expected[] = {"\xc3\xa4\xf0\x9f\x98\x80\n/", "\xef\xbf\xbdx",
                                           "a\xef\xbf\xbdz", "\xef\xbf\xbdzzzz"};
    char text[32];
    uint32_t value = json_first(&json, 0);
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(json_text(&json, value, text, sizeof text), strlen(expected[i]));
        assert_string_equal(text, expected[i]);
        value = json_after(&json, 0, value);
    }
    /* what does not fit is cut between characters, and its length told */
    value = json_first(&json, 0);
    assert_int_equal(json_text(&json, value, text, 4), 8);
    assert_string_equal(text, "\xc3\xa4");
    assert_int_equal(json_text(&json, 0, text, sizeof text), 0);
    json_finish(&json);
}

static void other_texts_are_refused(void **state)
{
    (void)state;
    static const char CUT[] = "the JSON is cut short", FIRST[] = "line 1 of the JSON is broken";
    refuse("", CUT);
    refuse("{\"a\": 1", CUT);
    refuse("[\"a", CUT);
    refuse("[1, ", CUT);
    refuse("[1,]", FIRST);
    refuse("{\"a\" 1}", FIRST);
    refuse("{a: 1}", FIRST);
    refuse("{\"a\": 1,}", FIRST);
    refuse("[1}", FIRST);
    refuse("[01]", FIRST);
    refuse("[1.]", FIRST);
    refuse("[.5]", FIRST);
    refuse("[+1]", FIRST);
    refuse("[NaN]", FIRST);
    refuse("[tru]", FIRST);
    refuse("[1] 2", FIRST);
    refuse("]", FIRST);
    refuse("[\n\n\"a\tb\"]", "line 3 of the JSON is broken");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_found),
        cmocka_unit_test(numbers_are_read),
        cmocka_unit_test(texts_are_decoded),
        cmocka_unit_test(other_texts_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
