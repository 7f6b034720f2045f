/* Checks each sorting algorithm that kiln's benchmark of sorts measures
 * (lib/bench/papers/sort_timer.c): its result must be the indices of the keys in ascending order of
 * the keys. If this fails, the benchmark reports the time of an algorithm that does not sort. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "bench/papers/bitonic_field.h"
#include "bench/papers/sort_timer.h"
#include "sort/pairs.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/simulation.h"
#include "support/sort_keys.h"

enum { MOST = 1 << 16 };

struct task {
    uint32_t keys[MOST];
    kiln_sort_pair expected[MOST]; /* pairs of key and place in the expected order */
};

/* Fills a task with `count` keys of a pattern, and with their expected order when each run of `set`
 * consecutive keys is sorted by itself. */
static void fill(struct task *task, enum pattern pattern, uint32_t count, uint32_t set)
{
    for (uint32_t i = 0; i < count; i++) {
        task->keys[i] = key_of(pattern, i, count);
        task->expected[i] = (kiln_sort_pair)task->keys[i] << 32 | i;
    }
    for (uint32_t i = 0; i < count; i += set)
        qsort(task->expected + i, set < count - i ? set : count - i, sizeof *task->expected,
              by_pair);
}

static void expect_result(struct kiln_sort_timer *timer, const struct task *task, uint32_t count,
                          const char *what)
{
    struct kiln_error error = {0};
    double ms = -1;
    if (!kiln_sort_timer_run(timer, task->keys, count, &ms, &error))
        fail_msg("%s: %s", what, error.message);
    assert_true(ms >= 0 && ms < 60e3);
    const uint32_t *places = kiln_sort_timer_places(timer, &error);
    assert_non_null(places);
    for (uint32_t i = 0; i < count; i++)
        if (places[i] != (uint32_t)task->expected[i])
            fail_msg("%s: %u at %u of %u instead of %u", what, places[i], i, count,
                     (uint32_t)task->expected[i]);
}

static void all_kinds_sort(void **state)
{
    static struct task task;
    static const uint32_t counts[] = {0, 1, 2, 3, 4, 1000, 1 << 14, MOST - 1, MOST};
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(2);
    for (int kind = 0; kind < KILN_SORT_TIMER_COUNT; kind++) {
        const char *name = kiln_sort_timer_name((enum kiln_sort_timer_kind)kind);
        struct kiln_sort_timer *timer =
            kiln_sort_timer_create(*state, threads, (enum kiln_sort_timer_kind)kind, MOST, &error);
        if (!timer)
            fail_msg("%s: %s", name, error.message);
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
            for (int pattern = 0; pattern < (counts[c] > 1000 ? 1 : PATTERNS); pattern++) {
                fill(&task, (enum pattern)pattern, counts[c], MOST);
                expect_result(timer, &task, counts[c], name);
            }
        kiln_sort_timer_destroy(&timer);
        assert_null(timer);
    }
    kiln_threads_destroy(&threads);
}

/* After kiln_sort_timer_restrict, the three variants of bitonic sort sort each set of `rows`
 * consecutive rows of the square field of keys by itself, and no key leaves its set. With 0 rows
 * they sort the whole field. */
static void variants_sort_sets_of_rows(void **state)
{
    static struct task task;
    static const uint32_t row_counts[] = {1, 2, 32, 128, 1024, 0, 1};
    const uint32_t count = 1 << 14, width = kiln_bitonic_field_width(count);
    assert_int_equal(width, 128);
    struct kiln_error error = {0};
    for (int kind = KILN_SORT_TIMER_COMPUTED; kind <= KILN_SORT_TIMER_PACKED; kind++) {
        struct kiln_sort_timer *timer =
            kiln_sort_timer_create(*state, NULL, (enum kiln_sort_timer_kind)kind, count, &error);
        if (!timer)
            fail_msg("%s", error.message);
        for (size_t r = 0; r < sizeof row_counts / sizeof *row_counts; r++) {
            const uint32_t rows = row_counts[r] ? row_counts[r] : count;
            fill(&task, RANDOM, count, rows * width);
            kiln_sort_timer_restrict(timer, row_counts[r]);
            expect_result(timer, &task, count,
                          kiln_sort_timer_name((enum kiln_sort_timer_kind)kind));
        }
        kiln_sort_timer_destroy(&timer);
    }
}

static void fields_are_square_or_twice_as_wide(void **state)
{
    (void)state;
    assert_int_equal(kiln_bitonic_field_width(1), 1);
    assert_int_equal(kiln_bitonic_field_width(2), 2);
    assert_int_equal(kiln_bitonic_field_width(1 << 17), 512);
    assert_int_equal(kiln_bitonic_field_width(1 << 20), 1024);
}

static void a_device_is_needed(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    for (int kind = KILN_SORT_TIMER_RADIX; kind < KILN_SORT_TIMER_COUNT; kind++) {
        error = (struct kiln_error){0};
        assert_null(kiln_sort_timer_create(NULL, NULL, (enum kiln_sort_timer_kind)kind, 1, &error));
        expect_error(&error, KILN_USAGE, "sort %s needs a device",
                     kiln_sort_timer_name((enum kiln_sort_timer_kind)kind));
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(all_kinds_sort),
        test_on_device(variants_sort_sets_of_rows),
        test_on_device(fields_are_square_or_twice_as_wide),
        test_on_device(a_device_is_needed),
    };
    return cmocka_run_group_tests_name("sort trials", tests, simulation_device_open,
                                       test_device_close);
}
