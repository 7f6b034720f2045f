/* The names of tests, which do not depend on how `kiln test` is called. */
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "kiln_program.h"
#include "support/cmocka.h"
#include "support/folders.h"

static const char test_file[] = "kiln_test: 1\nscene: fire.yaml\n";

/* An operand finds one test, of this name, with this folder of goldens. */
static void expect_found(const char *operand, const char *golden, const char *name)
{
    struct kiln_suite_params params = kiln_suite_defaults();
    struct kiln_error error = {0};
    params.paths = &operand;
    params.path_count = 1;
    params.golden = golden;
    struct kiln_suite *suite = kiln_suite_load(&params, &error);
    if (!suite)
        fail_msg("%s: %s", operand, error.message);
    assert_int_equal(kiln_suite_count(suite), 1);
    assert_string_equal(kiln_suite_test(suite, 0).name, name);
    kiln_suite_destroy(&suite);
}

static void a_test_has_one_name_however_it_is_found(void **state)
{
    (void)state;
    test_write_file("tests/eff/deep.test.yaml", test_file);
    test_write_file("goldens/readme.md", "");
    static const char *const operands[] = {
        ".", "tests", "tests/", "./tests/eff", "tests/eff/deep.test.yaml", "../%s/tests"};
    char folder[KILN_PATH_SIZE], operand[2 * KILN_PATH_SIZE], golden[2 * KILN_PATH_SIZE];
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(golden, sizeof golden, "%s/goldens", folder);
    for (size_t i = 0; i < sizeof operands / sizeof *operands; i++) {
        const char *name = strrchr(folder, '/') + 1, *at = strstr(operands[i], "%s");
        snprintf(operand, sizeof operand, "%.*s%s%s", at ? (int)(at - operands[i]) : 99,
                 operands[i], at ? name : "", at ? at + 2 : "");
        expect_found(operand, "goldens", "tests/eff/deep");
        expect_found(operand, golden, "tests/eff/deep");
        expect_found(operand, "tests/goldens", "eff/deep"); /* beside what is tested */
        expect_found(operand, "/nowhere/goldens", "deep");  /* nothing says where names begin */
    }
    test_write_file("tests/.kiln-tests", "");
    for (size_t i = 0; i + 1 < sizeof operands / sizeof *operands; i++) {
        expect_found(operands[i], "goldens", "eff/deep");
        expect_found(operands[i], "/nowhere/goldens", "eff/deep");
    }
    test_write_file("tests/eff/.kiln-tests", "");
    expect_found(".", "goldens", "deep"); /* the nearest mark counts */
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_test_has_one_name_however_it_is_found),
    };
    return cmocka_run_group_tests_name("names", tests, test_enter_folder, test_leave_folder);
}
