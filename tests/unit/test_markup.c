/* lib/report/markup.c: what is written into pages stays where it was put. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/embedded.h"
#include "report/markup.h"
#include "support/cmocka.h"
#include "support/errors.h"

static void assert_written(void (*write)(FILE *, const char *), const char *text,
                           const char *expected)
{
    char written[256] = "";
    FILE *out = fmemopen(written, sizeof written, "w");
    assert_non_null(out);
    write(out, text);
    fclose(out);
    assert_string_equal(written, expected);
}

static void text_cannot_leave_its_element(void **state)
{
    (void)state;
    assert_written(kiln_markup_write_text, "<img src=x onerror=\"a('b')\">&amp;",
                   "&lt;img src=x onerror=&quot;a(&#39;b&#39;)&quot;&gt;&amp;amp;");
    assert_written(kiln_markup_write_text, "\xc3\xa9 \xf0\x9f\x94\xa5\n\t",
                   "\xc3\xa9 \xf0\x9f\x94\xa5\n\t");
    assert_written(kiln_markup_write_text, "a\x1b[31mb\x7f\r\xff<",
                   "a\xef\xbf\xbd[31mb\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd&lt;");
    /* A sequence that is cut short does not swallow what comes after it. */
    assert_written(kiln_markup_write_text, "\xf0\x9f<b>", "\xef\xbf\xbd\xef\xbf\xbd&lt;b&gt;");
}

static void urls_name_files_and_nothing_else(void **state)
{
    (void)state;
    assert_written(kiln_markup_write_url, "../a b/c%d#1?x=\"<&'.png",
                   "../a%20b/c%25d%231%3Fx%3D%22%3C%26%27.png");
    assert_written(kiln_markup_write_url, "javascript:alert(1)", "javascript%3Aalert%281%29");
    assert_written(kiln_markup_write_url, "\xc3\xa9", "%C3%A9");
}

/* The vectors of RFC 4648, 10. */
static void base64_is_the_standard_one(void **state)
{
    (void)state;
    static const char *const expected[] = {"",         "Zg==",     "Zm8=",    "Zm9v",
                                           "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
    for (size_t length = 0; length <= 6; length++) {
        char written[64] = "";
        FILE *out = fmemopen(written, sizeof written, "w");
        assert_non_null(out);
        kiln_markup_write_base64(out, "foobar", length);
        fclose(out);
        assert_string_equal(written, expected[length]);
    }
    /* More than a block, with every value of a byte. */
    unsigned char bytes[10000];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (unsigned char)(i * 7 + i / 256);
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    kiln_markup_write_base64(out, bytes, sizeof bytes);
    fclose(out);
    assert_int_equal(size, (sizeof bytes + 2) / 3 * 4);
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < sizeof bytes; i++) {
        unsigned bits = 0;
        for (size_t c = 0; c < 4; c++) {
            const char *digit = strchr(digits, text[i / 3 * 4 + c]);
            bits = bits << 6 | (digit ? (unsigned)(digit - digits) & 63 : 0);
        }
        assert_int_equal(bits >> (16 - 8 * (i % 3)) & 255, bytes[i]);
    }
    free(text);
}

static void write_user(FILE *out, const void *user)
{
    fputs(user, out);
}

static void templates_are_filled(void **state)
{
    (void)state;
    const struct kiln_markup_field fields[] = {
        {"a", write_user, "{{b}}"}, {"ab", write_user, "x"}, {NULL, NULL, NULL}};
    struct kiln_error error = {0};
    char written[64] = "";
    FILE *out = fmemopen(written, sizeof written, "w");
    assert_non_null(out);
    assert_true(kiln_markup_write_template(out, "<{{ab}}{{a}}> } { {{ab}}", fields, &error));
    fclose(out);
    /* What a field wrote is no template itself. */
    assert_string_equal(written, "<x{{b}}> } { x");

    out = fmemopen(written, sizeof written, "w");
    assert_non_null(out);
    assert_false(kiln_markup_write_template(out, "{{b}}", fields, &error));
    expect_error(&error, KILN_USAGE, "template: unknown field 'b'");
    assert_false(kiln_markup_write_template(out, "{{a", fields, &error));
    expect_error(&error, KILN_USAGE, "template: '{{' without '}}': {{a");
    fclose(out);
}

static void the_page_is_in_the_library(void **state)
{
    (void)state;
    assert_non_null(strstr(kiln_embedded_find(kiln_embedded_page, "report.html"), "{{rows}}"));
    assert_null(kiln_embedded_find(kiln_embedded_page, "report"));
    assert_null(kiln_embedded_find(kiln_embedded_page, ""));
    /* Style and script go into their elements as they are. */
    for (const struct kiln_embedded_file *file = kiln_embedded_page; file->path; file++) {
        bool html = strstr(file->path, ".html") != NULL;
        assert_true(html || (!strstr(file->text, "</") && !strstr(file->text, "<!--")));
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_cannot_leave_its_element),
        cmocka_unit_test(urls_name_files_and_nothing_else),
        cmocka_unit_test(base64_is_the_standard_one),
        cmocka_unit_test(templates_are_filled),
        cmocka_unit_test(the_page_is_in_the_library),
    };
    return cmocka_run_group_tests_name("markup", tests, NULL, NULL);
}
