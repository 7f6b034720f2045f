/* lib/base/shown.c: what of a text is shown, and what is escaped. */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/json.h"
#include "base/shown.h"
#include "support/cmocka.h"
#include "support/errors.h"

/* Overrides and isolates of direction. */
#define RLO                                                                                        \
    "\xe2\x80"                                                                                     \
    "\xae"
#define PDF                                                                                        \
    "\xe2\x80"                                                                                     \
    "\xac"
#define LRI                                                                                        \
    "\xe2\x81"                                                                                     \
    "\xa6"
#define PDI                                                                                        \
    "\xe2\x81"                                                                                     \
    "\xa9"

static void what_acts_is_escaped(void **state)
{
    (void)state;
    static const char *const texts[][2] = {
        {"", ""},
        {"fire.yaml: 3 m, 45 deg \\ \"a\"", "fire.yaml: 3 m, 45 deg \\ \"a\""},
        {"Gl\xc3\xbchen \xe7\x81\xab \xf0\x9f\x94\xa5",
         "Gl\xc3\xbchen \xe7\x81\xab \xf0\x9f\x94\xa5"},
        {"\x1b[31mred\x1b[0m", "\\x1b[31mred\\x1b[0m"},
        {"a\nb\r\tc\x07\x7f", "a\\nb\\r\\tc\\x07\\x7f"},
        {"\xc2\x9b"
         "2J \xc2\x80",
         "\\u009b2J \\u0080"},
        {RLO "gpj.exe" PDF LRI "a" PDI, "\\u202egpj.exe\\u202c\\u2066a\\u2069"},
        {"\xe2\x80\x8e\xe2\x80\x8f\xd8\x9c\xe2\x80\xa8", "\\u200e\\u200f\\u061c\\u2028"},
        {"a\xc2\xa0"
         "b\xe2\x80\x8b\xe3\x80\x80\xef\xbb\xbf c",
         "a\\u00a0b\\u200b\\u3000\\ufeff c"},
        {"\xff\xc3(\xed\xa0\x80\xc0\x80", "\\xff\\xc3(\\xed\\xa0\\x80\\xc0\\x80"},
        {"end \xe2\x80", "end \\xe2\\x80"},
        {"\\x1b stays", "\\x1b stays"},
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char out[128], again[128];
        kiln_shown(out, sizeof out, texts[i][0]);
        assert_string_equal(out, texts[i][1]);
        kiln_shown(again, sizeof again, out);
        assert_string_equal(again, out);
    }
}

static void nothing_is_cut_in_two(void **state)
{
    (void)state;
    char out[16];
    for (size_t room = 1; room <= sizeof out; room++) {
        memset(out, 'x', sizeof out);
        kiln_shown(out, room, "a\x1b\xe7\x81\xab\xe7\x81\xab");
        const size_t length = strlen(out);
        assert_true(length < room);
        assert_true(length == 0 || length == 1 || length == 5 || length == 8 || length == 11);
    }
}

/* Every character below U+3000 by itself. */
static void whatever_is_shown_does_nothing(void **state)
{
    (void)state;
    for (uint32_t c = 1; c < 0x3000; c++) {
        char text[8] = {(char)c}, out[32];
        if (c >= 0x800)
            snprintf(text, sizeof text, "%c%c%c", (char)(0xe0 | c >> 12),
                     (char)(0x80 | (c >> 6 & 63)), (char)(0x80 | (c & 63)));
        else if (c >= 0x80)
            snprintf(text, sizeof text, "%c%c", (char)(0xc0 | c >> 6), (char)(0x80 | (c & 63)));
        uint32_t found;
        assert_int_equal(kiln_shown_character(text, &found), strlen(text));
        assert_int_equal(found, c);
        kiln_shown(out, sizeof out, text);
        assert_true(kiln_shown_needs_escape(c) ? out[0] == '\\' : strcmp(out, text) == 0);
    }
}

/* Errors, logs and JSON are where texts of files leave the library. */
static void messages_are_shown(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    kiln_error_set(&error, KILN_INVALID_INPUT, "%s: no layer '%s'", "a\x1b.exr", RLO PDF);
    expect_error(&error, KILN_INVALID_INPUT, "a\\x1b.exr: no layer '\\u202e\\u202c'");
    char most[2000] = "";
    for (size_t i = 0; i + 1 < sizeof most / 3 * 3; i++)
        most[i] = "\xe7\x81\xab"[i % 3];
    kiln_error_set(&error, KILN_INVALID_INPUT, "%s", most);
    assert_int_equal(strlen(error.message), 1023);
    assert_null(strchr(error.message, '\\'));
    kiln_error_set(&error, KILN_INVALID_INPUT, "a%s", most);
    assert_int_equal(strlen(error.message), 1021);
    assert_null(strchr(error.message, '\\'));
    struct kiln_text text = {0};
    kiln_text_add_json(&text, "\x1b \xc2\x9b " RLO PDF " \xff <\xe7\x81\xab>");
    assert_string_equal(text.data, "\"\\u001b \\u009b \\u202e\\u202c \\ufffd <\xe7\x81\xab>\"");
    kiln_text_free(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_acts_is_escaped),
        cmocka_unit_test(nothing_is_cut_in_two),
        cmocka_unit_test(whatever_is_shown_does_nothing),
        cmocka_unit_test(messages_are_shown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
