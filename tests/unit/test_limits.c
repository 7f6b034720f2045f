/* lib/job/limits.c and lib/base/budget.c: how limits are read, and what is within them. */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "base/budget.h"
#include "kiln.h"
#include "support/cmocka.h"
#include "support/errors.h"

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
    static const char LIMITS[] =
        "'' is not a limit; there are pixels, frames, steps, particles, memory, time, cpu, "
        "asset_pixels, asset_bytes, triangles, output, gas_cells, gas_steps, and the preset "
        "service";
#define A_NUMBER "; expected a number, with k, M or G behind it or without, or none"
#define BYTES    "; expected a number of bytes, kB, MB, GB, TB, KiB, MiB, GiB or TiB, or none"
#define SECONDS  "; expected seconds, or a time in ms, s, min or h, or none"
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", LIMITS},
        {"frames", "frames: found ''" A_NUMBER},
        {"frames=", "frames: found ''" A_NUMBER},
        {"frames=0", "frames: found '0'" A_NUMBER},
        {"frames=-1", "frames: found '-1'" A_NUMBER},
        {"frames=1 KiB", "frames: found '1 KiB'" A_NUMBER},
        {"memory=1k", "memory: found '1k'" BYTES},
        {"time=1 d", "time: found '1 d'" SECONDS},
        {"time=nan", "time: found 'nan'" SECONDS},
        {"time=inf", "time: found 'inf'" SECONDS},
        {"frames=1e30", "frames: found '1e30'" A_NUMBER},
        {"frame=1", "'frame' is not a limit; did you mean 'frames'?"},
        {"services", "'services' is not a limit; did you mean 'service'?"},
        {"service,,", LIMITS},
        {"frames=1;steps=2", "frames: found '1;steps=2'" A_NUMBER},
        {"output=1 GiB x", "output: found '1 GiB x'" BYTES},
        {"=3", LIMITS},
        {"memory=0.1", "memory: found '0.1'" BYTES},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_limits limits = kiln_limits_empty();
        struct kiln_error error = {0};
        if (kiln_limits_parse(&limits, cases[i].text, &error))
            fail_msg("'%s' was taken", cases[i].text);
        expect_error(&error, KILN_USAGE, "%s", cases[i].message);
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
    expect_error(&error, KILN_OVER_LIMIT,
                 "b.obj: 11 triangles of meshes, and the limit `triangles` is 10");
    assert_false(kiln_budget_take(budget, KILN_LIMIT_triangles, 0, "c", &error));
    assert_true(kiln_budget_is_kept(budget, &error));
    kiln_budget_destroy(&budget);
    assert_true(kiln_budget_take(NULL, KILN_LIMIT_output, UINT64_MAX, "d", &error));
    assert_true(kiln_budget_is_kept(NULL, &error));
}

/* told: what an error says behind the amount, which is another one in each run. */
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
        expect_error_around(&error, KILN_OVER_LIMIT, told, "the job has taken ");
    }
    return kept;
}

static void time_and_memory_are_those_of_the_process(void **state)
{
    (void)state;
    assert_false(is_kept(KILN_LIMIT_time, 10, " s since it began, and the limit `time` is 0.01 s"));
    assert_true(is_kept(KILN_LIMIT_time, 1000000, ""));
    assert_true(is_kept(KILN_LIMIT_cpu, 1000000, ""));
    assert_false(
        is_kept(KILN_LIMIT_memory, 1000, " of memory, and the limit `memory` is 1000 bytes"));
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
