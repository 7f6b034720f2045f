/* lib/job/limits.c and lib/base/budget.c: how limits are read, and what is within them. */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "base/budget.h"
#include "kiln.h"
#include "support/cmocka.h"

static uint64_t read_one(const char *text, enum kiln_limit limit)
{
    struct kiln_limits limits = kiln_limits_empty();
    struct kiln_error error = {0};
    if (!kiln_limits_parse(&limits, text, &error))
        fail_msg("%s: %s", text, error.message);
    return limits.most[limit];
}

static void amounts_have_units(void **state)
{
    (void)state;
    assert_int_equal(read_one("frames=12", KILN_LIMIT_frames), 12);
    assert_int_equal(read_one("particles=1.5M", KILN_LIMIT_particles), 1500000);
    assert_int_equal(read_one("triangles=20 k", KILN_LIMIT_triangles), 20000);
    assert_int_equal(read_one("memory=4 GiB", KILN_LIMIT_memory), 4294967296);
    assert_int_equal(read_one("output=1 TB", KILN_LIMIT_output), 1000000000000);
    assert_int_equal(read_one("asset_bytes=100", KILN_LIMIT_asset_bytes), 100);
    assert_int_equal(read_one("time=2", KILN_LIMIT_time), 2000);
    assert_int_equal(read_one("time=1.5 min", KILN_LIMIT_time), 90000);
    assert_int_equal(read_one("cpu=20ms", KILN_LIMIT_cpu), 20);
    assert_int_equal(read_one("cpu=2 h", KILN_LIMIT_cpu), 7200000);
}

static void what_comes_later_counts(void **state)
{
    (void)state;
    struct kiln_limits limits = kiln_limits_empty();
    struct kiln_error error = {0};
    assert_true(kiln_limits_parse(&limits, "frames=7,service,pixels=none,steps=5", &error));
    assert_int_equal(limits.most[KILN_LIMIT_frames], 100000);
    assert_int_equal(limits.most[KILN_LIMIT_pixels], 0);
    assert_int_equal(limits.most[KILN_LIMIT_steps], 5);
    assert_int_equal(limits.most[KILN_LIMIT_memory], 4294967296);
    assert_true(kiln_limits_parse(&limits, "steps=none", &error));
    assert_int_equal(limits.most[KILN_LIMIT_steps], 0);
    assert_int_equal(limits.most[KILN_LIMIT_frames], 100000);
}

static void nonsense_is_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",          "frames",       "frames=",          "frames=0",
        "frames=-1", "frames=1 KiB", "memory=1k",        "time=1 d",
        "time=nan",  "time=inf",     "frames=1e30",      "frame=1",
        "services",  "service,,",    "frames=1;steps=2", "output=1 GiB x",
        "=3",        "memory=0.1",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct kiln_limits limits = kiln_limits_empty();
        struct kiln_error error = {0};
        if (kiln_limits_parse(&limits, texts[i], &error))
            fail_msg("'%s' was taken", texts[i]);
        assert_int_equal(error.code, KILN_USAGE);
        assert_true(strlen(error.message) > 10);
    }
}

static void amounts_that_round_alike_are_told_in_bytes(void **state)
{
    (void)state;
    char text[160];
    struct kiln_limits limits = kiln_limits_empty();
    limits.most[KILN_LIMIT_memory] = (uint64_t)4 << 30;
    struct kiln_budget *budget = kiln_budget_create(&limits);
    assert_false(kiln_budget_allows(budget, KILN_LIMIT_memory, ((uint64_t)4 << 30) + 4096, text));
    assert_string_equal(text,
                        "4294971392 bytes of memory, and the limit `memory` is 4294967296 bytes");
    assert_false(kiln_budget_allows(budget, KILN_LIMIT_memory, (uint64_t)5 << 30, text));
    assert_string_equal(text, "5 GiB of memory, and the limit `memory` is 4 GiB");
    kiln_budget_destroy(&budget);
}

static void sums_stay_over_their_limit(void **state)
{
    (void)state;
    struct kiln_limits limits = kiln_limits_empty();
    struct kiln_error error = {0};
    limits.most[KILN_LIMIT_triangles] = 10;
    struct kiln_budget *budget = kiln_budget_create(&limits);
    assert_true(kiln_budget_take(budget, KILN_LIMIT_triangles, 10, "a", &error));
    assert_true(kiln_budget_take(budget, KILN_LIMIT_pixels, UINT64_MAX, "a", &error));
    assert_false(kiln_budget_take(budget, KILN_LIMIT_triangles, 1, "b.obj", &error));
    assert_int_equal(error.code, KILN_OVER_LIMIT);
    assert_string_equal(error.message,
                        "b.obj: 11 triangles of meshes, and the limit `triangles` is 10");
    assert_false(kiln_budget_take(budget, KILN_LIMIT_triangles, 0, "c", &error));
    assert_true(kiln_budget_is_kept(budget, &error));
    kiln_budget_destroy(&budget);
    assert_true(kiln_budget_take(NULL, KILN_LIMIT_output, UINT64_MAX, "d", &error));
    assert_true(kiln_budget_is_kept(NULL, &error));
}

static bool is_kept(enum kiln_limit limit, uint64_t most, const char *told)
{
    struct kiln_limits limits = kiln_limits_empty();
    struct kiln_error error = {0};
    limits.most[limit] = most;
    struct kiln_budget *budget = kiln_budget_create(&limits);
    nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    const bool kept = kiln_budget_is_kept(budget, &error);
    kiln_budget_destroy(&budget);
    if (!kept) {
        assert_int_equal(error.code, KILN_OVER_LIMIT);
        assert_non_null(strstr(error.message, told));
    }
    return kept;
}

static void time_and_memory_are_those_of_the_process(void **state)
{
    (void)state;
    assert_false(is_kept(KILN_LIMIT_time, 10, "the limit `time` is 0.01 s"));
    assert_true(is_kept(KILN_LIMIT_time, 1000000, ""));
    assert_true(is_kept(KILN_LIMIT_cpu, 1000000, ""));
    assert_false(is_kept(KILN_LIMIT_memory, 1000, "the limit `memory` is 1000 bytes"));
    assert_true(is_kept(KILN_LIMIT_memory, (uint64_t)1 << 45, ""));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(amounts_have_units),
        cmocka_unit_test(what_comes_later_counts),
        cmocka_unit_test(nonsense_is_refused),
        cmocka_unit_test(amounts_that_round_alike_are_told_in_bytes),
        cmocka_unit_test(sums_stay_over_their_limit),
        cmocka_unit_test(time_and_memory_are_those_of_the_process),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
