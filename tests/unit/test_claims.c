/* lib/base/claims.c: one file under any two paths is one file, and other files are others. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "kiln_program.h"
#include "support/cmocka.h"
#include "support/errors.h"

/* A fresh folder, which is the working folder. */
static int enter_folder(void **state)
{
    char *folder = strdup("/tmp/kiln-claims-XXXXXX");
    *state = folder;
    return folder && mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int leave_folder(void **state)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", (char *)*state);
    int code = chdir("/") == 0 ? system(command) : -1; /* NOLINT(cert-env33-c): a name of ours */
    free(*state);
    return code;
}

static void make_file(const char *path)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fclose(file);
}

/* Whether two paths can be written in one call. */
static bool may_write_both(const char *a, const char *b)
{
    struct kiln_error error = {0};
    struct kiln_claims *claims = kiln_claims_create();
    assert_non_null(claims);
    assert_true(kiln_claims_write(claims, a, "--first", &error));
    bool both = kiln_claims_write(claims, b, "--second", &error);
    assert_int_equal(error.code, both ? KILN_OK : KILN_USAGE);
    if (!both)
        expect_error(&error, KILN_USAGE, "%s: --first and --second would both write this file", b);
    kiln_claims_destroy(&claims);
    assert_null(claims);
    return both;
}

static void spellings_of_what_is_not_there(void **state)
{
    char absolute[128];
    snprintf(absolute, sizeof absolute, "%s/a", (char *)*state);
    assert_false(may_write_both("a", "a"));
    assert_false(may_write_both("a", "./a"));
    assert_false(may_write_both("a", ".//.///a"));
    assert_false(may_write_both("a", absolute));
    assert_false(may_write_both("a", "no/such/../../a"));
    assert_false(may_write_both("no/such/a", "no/./such/../such/a"));
    assert_false(may_write_both("/", "/.."));
    assert_true(may_write_both("a", "A"));
    assert_true(may_write_both("a", "b"));
    assert_true(may_write_both("a", "no/a"));
    assert_true(may_write_both("no/a", "no/such/a"));
}

static void links_lead_to_what_they_name(void **state)
{
    (void)state;
    assert_int_equal(mkdir("folder", 0777), 0);
    assert_int_equal(symlink("folder", "way"), 0);
    assert_false(may_write_both("folder/a", "way/a"));
    assert_false(may_write_both("folder/no/a", "way/no/./a"));
    assert_true(may_write_both("a", "way/a"));

    make_file("file");
    assert_int_equal(link("file", "hard"), 0);
    assert_int_equal(symlink("file", "soft"), 0);
    assert_int_equal(symlink("nowhere", "dangling"), 0);
    assert_false(may_write_both("file", "hard"));
    assert_false(may_write_both("soft", "hard"));
    assert_false(may_write_both("dangling", "./dangling"));
    assert_true(may_write_both("file", "dangling"));
}

static void what_is_read_is_not_written(void **state)
{
    (void)state;
    for (int written_first = 0; written_first < 2; written_first++) {
        struct kiln_error error = {0};
        struct kiln_claims *claims = kiln_claims_create();
        assert_non_null(claims);
        if (written_first)
            assert_true(kiln_claims_write(claims, "./out", "--output", &error));
        else
            assert_true(kiln_claims_read(claims, "out", "a mask", &error));
        bool both = written_first ? kiln_claims_read(claims, "out", "a mask", &error)
                                  : kiln_claims_write(claims, "./out", "--output", &error);
        assert_false(both);
        expect_error(&error, KILN_USAGE,
                     "%s: --output would replace a mask, which this command reads",
                     written_first ? "out" : "./out");
        kiln_claims_destroy(&claims);
    }
}

static void reading_twice_is_no_conflict(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_claims *claims = kiln_claims_create();
    assert_non_null(claims);
    assert_true(kiln_claims_read(claims, "in", "the scene", &error));
    assert_true(kiln_claims_read(claims, "./in", "a mask", &error));
    assert_false(kiln_claims_write(claims, "in", "--output", &error));
    kiln_claims_destroy(&claims);
}

/* The frames of a long clip, each of which is found again. */
static void thousands(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    struct kiln_error error = {0};
    struct kiln_claims *claims = kiln_claims_create();
    assert_non_null(claims);
    char path[64];
    for (int i = 0; i < COUNT; i++) {
        snprintf(path, sizeof path, "frames/f_%d.png", i);
        assert_true(kiln_claims_write(claims, path, "--output", &error));
    }
    for (int i = 0; i < COUNT; i += 7) {
        snprintf(path, sizeof path, "frames/f_%d.png", i);
        assert_false(kiln_claims_read(claims, path, "a mask", &error));
    }
    assert_true(kiln_claims_read(claims, "frames/f_20000.png", "a mask", &error));
    kiln_claims_destroy(&claims);
}

static void a_path_may_be_too_long(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_claims *claims = kiln_claims_create();
    assert_non_null(claims);
    char path[2 * KILN_PATH_SIZE];
    memset(path, 'x', sizeof path);
    path[sizeof path - 1] = '\0';
    assert_true(kiln_claims_read(claims, path, "a mask", &error)); /* nobody can open it */
    assert_false(kiln_claims_write(claims, path, "--output", &error));
    expect_error(&error, KILN_USAGE, "%.200s...: the path is longer than 4095 bytes", path);
    kiln_claims_destroy(&claims);
}

/* From a folder whose path is too long, short names still lead to files. */
static void the_folder_may_be_too_deep(void **state)
{
    struct kiln_error error = {0};
    char name[251];
    memset(name, 'd', sizeof name);
    name[sizeof name - 1] = '\0';
    for (int i = 0; i * (int)sizeof name < KILN_PATH_SIZE; i++) {
        assert_int_equal(mkdir(name, 0777), 0);
        assert_int_equal(chdir(name), 0);
    }
    make_file("file");
    struct kiln_claims *claims = kiln_claims_create();
    assert_non_null(claims);
    assert_true(kiln_claims_read(claims, "file", "the scene", &error));
    assert_false(kiln_claims_write(claims, "file", "--output", &error));
    expect_error(&error, KILN_USAGE, "file: the absolute path is longer than 4095 bytes");
    kiln_claims_destroy(&claims);
    assert_int_equal(chdir(*state), 0);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(spellings_of_what_is_not_there),
        cmocka_unit_test(links_lead_to_what_they_name),
        cmocka_unit_test(what_is_read_is_not_written),
        cmocka_unit_test(reading_twice_is_no_conflict),
        cmocka_unit_test(thousands),
        cmocka_unit_test(a_path_may_be_too_long),
        cmocka_unit_test(the_folder_may_be_too_deep),
    };
    return cmocka_run_group_tests_name("claims", tests, enter_folder, leave_folder);
}
