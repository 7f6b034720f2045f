/* The functions of kiln.h and kiln_program.h that destroy, close or end an object do nothing for
 * NULL and for a pointer to NULL. If this fails, a program that cleans up after an error crashes.
 */
#include <glob.h>
#include <regex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kiln_program.h"
#include "support/cmocka.h"

/* Defines a function that calls `destroy` for a pointer to NULL and for NULL. */
#define DESTROY(type, destroy)                                                                     \
    static void call_##destroy(void)                                                               \
    {                                                                                              \
        struct type *none = NULL;                                                                  \
        destroy(&none);                                                                            \
        assert_null(none);                                                                         \
        destroy(NULL);                                                                             \
    }
DESTROY(kiln_batch, kiln_batch_destroy)
DESTROY(kiln_bench, kiln_bench_destroy)
DESTROY(kiln_budget, kiln_budget_destroy)
DESTROY(kiln_cancel, kiln_cancel_destroy)
DESTROY(kiln_claims, kiln_claims_destroy)
DESTROY(kiln_device, kiln_device_close)
DESTROY(kiln_figure_list, kiln_figure_list_destroy)
DESTROY(kiln_frame, kiln_frame_destroy)
DESTROY(kiln_results, kiln_results_destroy)
DESTROY(kiln_scene, kiln_scene_destroy)
DESTROY(kiln_suite, kiln_suite_destroy)

static void call_kiln_rendering_end(void)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_rendering *none = NULL;
    assert_true(kiln_rendering_end(&none, NULL, &error));
    assert_true(kiln_rendering_end(NULL, NULL, &error));
    assert_int_equal(error.code, KILN_OK);
}

static void call_kiln_text_file_close(void)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_text_file *none = NULL;
    assert_true(kiln_text_file_close(&none, true, &error));
    assert_true(kiln_text_file_close(NULL, true, &error));
    assert_int_equal(error.code, KILN_OK);
}

#define ROW(function)                                                                              \
    {                                                                                              \
        .name = #function, .call = call_##function                                                 \
    }
static const struct {
    const char *name;
    void (*call)(void);
} destroyers[] = {
    ROW(kiln_batch_destroy),       ROW(kiln_bench_destroy),  ROW(kiln_budget_destroy),
    ROW(kiln_cancel_destroy),      ROW(kiln_claims_destroy), ROW(kiln_device_close),
    ROW(kiln_figure_list_destroy), ROW(kiln_frame_destroy),  ROW(kiln_rendering_end),
    ROW(kiln_results_destroy),     ROW(kiln_scene_destroy),  ROW(kiln_suite_destroy),
    ROW(kiln_text_file_close),
};
#undef ROW
enum { COUNT = sizeof destroyers / sizeof *destroyers };

static void nothing_is_destroyed(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT; i++)
        destroyers[i].call();
}

static bool is_known(const char *name, size_t length)
{
    for (size_t i = 0; i < COUNT; i++)
        if (strlen(destroyers[i].name) == length && strncmp(destroyers[i].name, name, length) == 0)
            return true;
    return false;
}

/* Checks the declarations of a header. A function is a destroyer if it sets a pointer of the caller
 * to NULL: its first parameter is a pointer to a pointer to a struct. A function whose name sounds
 * like a destroyer's is one, too, except those of the writer of JSON, which lies in a variable of
 * the caller. Returns the number of destroyers. */
static size_t check_header(const char *text)
{
    regex_t declaration;
    regmatch_t at[3];
    size_t found = 0;
    assert_int_equal(
        regcomp(&declaration,
                "(kiln_[a-z_]+)\\([[:space:]]*struct kiln_[a-z_]+ \\*\\*[a-z]"
                "|(kiln_[a-z_]+_(destroy|close|end|finish|free|release))\\([[:space:]]*struct",
                REG_EXTENDED),
        0);
    for (; regexec(&declaration, text, 3, at, 0) == 0; text += at[0].rm_eo) {
        const regmatch_t name = at[1].rm_so >= 0 ? at[1] : at[2];
        const size_t length = (size_t)(name.rm_eo - name.rm_so);
        if (strncmp(text + name.rm_so, "kiln_json_", strlen("kiln_json_")) == 0)
            continue;
        if (!is_known(text + name.rm_so, length))
            fail_msg("%.*s has no row in test_destroyers.c", (int)length, text + name.rm_so);
        found++;
    }
    regfree(&declaration);
    return found;
}

static void every_destroyer_is_called_here(void **state)
{
    (void)state;
    enum { ROOM = 1 << 16 };
    static char text[ROOM];
    size_t found = 0;
    glob_t headers;
    assert_int_equal(glob(KILN_SOURCE_DIR "/lib/kiln*.h", 0, NULL, &headers), 0);
    for (size_t i = 0; i < headers.gl_pathc; i++) {
        FILE *file = fopen(headers.gl_pathv[i], "r");
        assert_non_null(file);
        const size_t length = fread(text, 1, ROOM, file);
        fclose(file);
        assert_in_range(length, 1, ROOM - 1);
        text[length] = '\0';
        found += check_header(text);
    }
    globfree(&headers);
    assert_int_equal(found, COUNT);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_destroyed),
        cmocka_unit_test(every_destroyer_is_called_here),
    };
    return cmocka_run_group_tests_name("destroyers", tests, NULL, NULL);
}
