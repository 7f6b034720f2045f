/* lib/base/order.c: names of numbered files are in the order of their numbers. */
#include <stdlib.h>
#include <string.h>

#include "base/order.h"
#include "support/cmocka.h"

/* Each list is in its order. */
static const char *const lists[][8] = {
    {"0.png", "1.png", "2.png", "10.png", "11.png", "100.png"},
    {"a.-10.exr", "a.-2.exr", "a.0.exr", "a.1.exr", "a.10.exr"},
    {"-3", "-2", "0", "4"},
    {"a-1.png", "a-2.png", "a-10.png"},
    {"f1_s2", "f1_s10", "f2_s1"},
    {"001.png", "01.png", "1.png", "2.png"},
    {"99999999999999999999998", "99999999999999999999999", "100000000000000000000000"},
    {"", "a", "a1", "a1b", "b"},
    {"A", "B", "a", "\xc3\xa4"},
};

static int by_order(const void *a, const void *b)
{
    return kiln_order_names(*(const char *const *)a, *(const char *const *)b);
}

static void numbers_are_numbers(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        size_t count = 0;
        while (count < 8 && lists[i][count])
            count++;
        for (size_t k = 0; k < count; k++) {
            for (size_t m = 0; m < count; m++) {
                const int order = kiln_order_names(lists[i][k], lists[i][m]);
                if (!(k < m ? order < 0 : k > m ? order > 0 : order == 0))
                    fail_msg("%s against %s: %d", lists[i][k], lists[i][m], order);
            }
        }
        const char *sorted[8];
        for (size_t k = 0; k < count; k++)
            sorted[k] = lists[i][count - 1 - k];
        qsort(sorted, count, sizeof *sorted, by_order);
        for (size_t k = 0; k < count; k++)
            assert_string_equal(sorted[k], lists[i][k]);
    }
}

static void gaps_are_counted(void **state)
{
    (void)state;
    static const struct {
        const char *a, *b;
        uint32_t gap;
    } pairs[] = {
        {"1.png", "2.png", 0},         {"1.png", "3.png", 1},
        {"a_009.png", "a_011.png", 1}, {"9.png", "100.png", 90},
        {"-2.png", "2.png", 3},        {"1_1.png", "3_3.png", 0},
        {"1.png", "3.exr", 0},         {"left.png", "up.png", 0},
        {"1.png", "1.png", 0},         {"3.png", "1.png", 0},
        {"a1.png", "a1_3.png", 0},     {"1.png", "99999999999999999999.png", 999999},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        assert_int_equal(kiln_order_gap(pairs[i].a, pairs[i].b), pairs[i].gap);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_numbers),
        cmocka_unit_test(gaps_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
