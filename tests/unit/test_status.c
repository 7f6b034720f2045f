/* What became of tests, as names and as exit codes. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "kiln_program.h"
#include "support/cmocka.h"

static void every_status_has_a_name(void **state)
{
    (void)state;
    for (int i = 0; i < KILN_TEST_STATUS_COUNT; i++) {
        const char *name = kiln_test_status_name((enum kiln_test_status)i);
        assert_true(name[0] != '\0');
        for (int j = 0; j < i; j++)
            assert_string_not_equal(name, kiln_test_status_name((enum kiln_test_status)j));
    }
    assert_string_equal(kiln_test_status_name(KILN_TEST_STATUS_COUNT), "");
}

static void of_two_codes_the_worse_counts(void **state)
{
    (void)state;
    static const enum kiln_code best_first[] = {
        KILN_OK,         KILN_READER_GONE,   KILN_GOLDEN_MISSING, KILN_FRAME_FAILED,
        KILN_USAGE,      KILN_INVALID_INPUT, KILN_NO_DEVICE,      KILN_IO,
        KILN_OVER_LIMIT, KILN_DEVICE_FAILED, KILN_INTERRUPTED,
    };
    size_t count = sizeof best_first / sizeof *best_first;
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j <= i; j++) {
            assert_int_equal(kiln_code_worse(best_first[i], best_first[j]), best_first[i]);
            assert_int_equal(kiln_code_worse(best_first[j], best_first[i]), best_first[i]);
        }
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_status_has_a_name),
        cmocka_unit_test(of_two_codes_the_worse_counts),
    };
    return cmocka_run_group_tests_name("status", tests, NULL, NULL);
}
