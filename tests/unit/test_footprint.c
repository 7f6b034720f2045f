/* lib/base/footprint: sums of expected memory, up to numbers that do not fit. */
#include "base/footprint.h"
#include "support/cmocka.h"

static void adds_up_what_stays_and_the_most_that_passes(void **state)
{
    (void)state;
    struct kiln_footprint footprint = {.threads = 1};
    kiln_footprint_add(&footprint, KILN_FOOTPRINT_PICTURE, 10, 4);
    kiln_footprint_add(&footprint, KILN_FOOTPRINT_OBJECTS, 3, 100);
    kiln_footprint_pass(&footprint, KILN_FOOTPRINT_TEXTURES, 500);
    kiln_footprint_pass(&footprint, KILN_FOOTPRINT_OBJECTS, 70);
    assert_int_equal(kiln_footprint_total(&footprint), 40 + 300 + 500);
    assert_int_equal(kiln_footprint_largest(&footprint), KILN_FOOTPRINT_TEXTURES);
    kiln_footprint_add(&footprint, KILN_FOOTPRINT_OBJECTS, 3, 100);
    assert_int_equal(kiln_footprint_largest(&footprint), KILN_FOOTPRINT_OBJECTS);
}

static void stays_at_the_greatest_number(void **state)
{
    (void)state;
    struct kiln_footprint footprint = {.threads = 1};
    kiln_footprint_add(&footprint, KILN_FOOTPRINT_LIGHTS, UINT64_MAX / 2, 3);
    assert_true(kiln_footprint_total(&footprint) == UINT64_MAX);
    kiln_footprint_add(&footprint, KILN_FOOTPRINT_LIGHTS, 1, 1);
    kiln_footprint_add(&footprint, KILN_FOOTPRINT_PICTURE, 1, 1);
    assert_true(kiln_footprint_total(&footprint) == UINT64_MAX);
    assert_int_equal(kiln_footprint_largest(&footprint), KILN_FOOTPRINT_LIGHTS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(adds_up_what_stays_and_the_most_that_passes),
        cmocka_unit_test(stays_at_the_greatest_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
