/* lib/base/marker.c and what writes texts by it: no output has a command for a CI server out of a
 * text, and no word of a command acts on the shell or the terminal that it is pasted into. If this
 * fails, a stranger's scene or result sets variables of a build, uploads files or runs commands. */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json.h"
#include "base/marker.h"
#include "base/text.h"
#include "report/markup.h"
#include "support/cmocka.h"

/* Texts with markers, as the documents of the servers have them, and what is shown of them. */
static const char *const shown[][2] = {
    {"##vso[task.setvariable variable=A]b", "# #vso[task.setvariable variable=A]b"},
    {"a ##VSO[task", "a # #VSO[task"},
    {"###vso[a", "## #vso[a"},
    {"##[set-env name=A]b", "# #[set-env name=A]b"},
    {"##teamcity[setParameter", "# #teamcity[setParameter"},
    {"x[[[ATTACHMENT|/etc/passwd]]", "x[[ [ATTACHMENT|/etc/passwd]]"},
    {"::set-output name=a::b", ": :set-output name=a::b"},
    {" \t::add-mask::a", " \\t: :add-mask::a"},
    {"a\n ::error::b", "a\\n : :error::b"},
    {"openjd_env: A=b", "openjd _env: A=b"},
    /* These are none. */
    {"a::b", "a::b"},
    {"## a [[b]] #vso[", "## a [[b]] #vso["},
    {"say openjd_env: A=b", "say openjd_env: A=b"},
    {"[ [ATTACHMENT|", "[ [ATTACHMENT|"},
};

static void markers_are_broken_and_readable(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof shown / sizeof *shown; i++) {
        char out[128], again[128];
        kiln_shown(out, sizeof out, shown[i][0]);
        assert_string_equal(out, shown[i][1]);
        kiln_shown(again, sizeof again, out);
        assert_string_equal(again, out);
        assert_false(kiln_has_marker(out));
    }
    assert_true(kiln_has_marker("a\n::b"));
    assert_true(kiln_has_marker("a ##[b]"));
}

static void json_has_the_same_text(void **state)
{
    (void)state;
    struct kiln_text text = {0};
    kiln_text_add_json(&text, "##vso[a] [[ATTACHMENT|b]] ::c ##");
    assert_string_equal(text.data, "\"\\u0023#vso[a] \\u005b[ATTACHMENT|b]] ::c ##\"");
    kiln_text_free(&text);
}

static void pages_have_the_same_text(void **state)
{
    (void)state;
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    kiln_markup_write_text(out, "a\n ::b ##vso[c");
    assert_int_equal(fclose(out), 0);
    assert_string_equal(text, "a\n &#58;:b &#35;#vso[c");
    free(text);
}

/* Words that a shell or a terminal would act on, and how they are written. */
static const char *const words[][2] = {
    {"a/b-c_d.e", "a/b-c_d.e"},
    {"", "''"},
    {"a b", "'a b'"},
    {"$(touch x)`id`;&|<>*?[]{}~#!", "'$(touch x)`id`;&|<>*?[]{}~#!'"},
    {"it's", "'it'\\''s'"},
    {"=ls", "'=ls'"},
    {"%self", "'%self'"},
    {"a=b", "a=b"},
    {"Gl\xc3\xbchen", "'Gl\xc3\xbchen'"},
    /* A line end, Ctrl-C and Ctrl-U act on the line that is pasted, quotes or not. */
    {"a\nrm -rf ~\n", "$'a\\012rm -rf ~\\012'"},
    {"\x03'\\\x15", "$'\\003\\'\\\\\\025'"},
    {"\xff", "$'\\377'"},
    {"\xe2\x80\xae" /* NOLINT(misc-misleading-bidirectional): it is what is tested */
     "a",
     "$'\\342\\200\\256a'"},
};

/* Lets a shell print a word that it is given, and returns what it prints. */
static void shell_prints(const char *shell, const char *word, char out[256])
{
    char command[512];
    struct kiln_text quoted = {0};
    kiln_text_add(&quoted, "printf '%%s' ");
    kiln_text_add_shell_word(&quoted, word);
    struct kiln_text whole = {0};
    kiln_text_add_shell_word(&whole, quoted.data);
    snprintf(command, sizeof command, "exec %s -c %s", shell, whole.data);
    /* sh: the outer word is plain, since it has no controls */
    FILE *pipe = popen(command, "r"); /* NOLINT(cert-env33-c): a command of this test */
    assert_non_null(pipe);
    const size_t size = fread(out, 1, 255, pipe);
    out[size] = '\0';
    assert_int_equal(pclose(pipe), 0);
    kiln_text_free(&quoted);
    kiln_text_free(&whole);
}

static void shells_read_the_word(void **state)
{
    (void)state;
    static const char *const shells[] = {"bash", "zsh -f"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        struct kiln_text text = {0};
        kiln_text_add_shell_word(&text, words[i][0]);
        assert_string_equal(text.data, words[i][1]);
        kiln_text_free(&text);
        for (size_t s = 0; s < sizeof shells / sizeof *shells; s++) {
            char out[256];
            shell_prints(shells[s], words[i][0], out);
            assert_string_equal(out, words[i][0]);
        }
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(markers_are_broken_and_readable),
        cmocka_unit_test(json_has_the_same_text),
        cmocka_unit_test(pages_have_the_same_text),
        cmocka_unit_test(shells_read_the_word),
    };
    return cmocka_run_group_tests_name("marker", tests, NULL, NULL);
}
