/* lib/particles/births: counts equal the integral of the rate, times are exact and evenly spread.
 */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "particles/births.h"
#include "support/cmocka.h"

static float constant_rate(const void *context, float time_s)
{
    (void)time_s;
    return *(const float *)context;
}

/* 0 before 1 s, then up by 100 a second each second until 3 s, then 200. */
static float ramp_rate(const void *context, float time_s)
{
    (void)context;
    return time_s < 1.0f ? 0.0f : time_s < 3.0f ? (time_s - 1.0f) * 100.0f : 200.0f;
}

static struct kiln_births_source at_60_hz(const float *rate)
{
    return (struct kiln_births_source){
        .rate = constant_rate, .context = rate, .steps_num = 60, .steps_den = 1};
}

static struct kiln_burst once(double time_s, uint32_t count)
{
    return (struct kiln_burst){.time_s = time_s, .count = {count, count}};
}

static double birth_time(uint32_t step, const struct kiln_birth_group *group, uint32_t j)
{
    return step - 1 + (group->first + j * group->spacing) / 4294967296.0;
}

static void five_a_second_come_every_fifth_of_a_second(void **state)
{
    (void)state;
    float rate = 5.0f;
    struct kiln_births_source source = at_60_hz(&rate);
    uint64_t wait = 0;
    for (uint32_t step = 1; step <= 100000; step++) {
        struct kiln_births births;
        kiln_births_step(&source, step, &wait, &births);
        bool due = (step - 1) % 12 == 0;
        assert_int_equal(births.count, due);
        assert_int_equal(births.group_count, due);
        if (due)
            assert_int_equal(births.groups[0].first, 0);
    }
}

/* Rates and frame rates that do not divide: birth n must lie at n / rate seconds. */
static void births_lie_where_the_integral_is_whole(void **state)
{
    (void)state;
    static const float rates[] = {0.37f, 7.0f, 59.94f, 1234.5f, 20000.0f, 1e6f};
    for (size_t r = 0; r < sizeof rates / sizeof *rates; r++) {
        struct kiln_births_source source = at_60_hz(&rates[r]);
        source.steps_num = 60000;
        source.steps_den = 1001;
        double per_step = (double)rates[r] * 1001.0 / 60000.0;
        uint64_t wait = 0, born = 0;
        for (uint32_t step = 1; step <= 2000; step++) {
            struct kiln_births births;
            kiln_births_step(&source, step, &wait, &births);
            for (uint32_t j = 0; j < births.count; j++) {
                double expected = (double)(born + j) / per_step;
                double error = birth_time(step, &births.groups[0], j) - expected;
                /* each spacing is rounded down by less than 2^-32 of a step */
                assert_true(error < 1e-6 && error > -1e-6 - j / 4294967296.0);
            }
            born += births.count;
            assert_true(born == (uint64_t)ceil(per_step * step - 1e-9));
        }
    }
}

static void keyed_rates_are_integrated(void **state)
{
    (void)state;
    struct kiln_births_source source = {.rate = ramp_rate, .steps_num = 60, .steps_den = 1};
    uint64_t wait = 0, born = 0;
    for (uint32_t step = 1; step <= 300; step++) {
        struct kiln_births births;
        kiln_births_step(&source, step, &wait, &births);
        born += births.count;
        double t = step / 60.0;
        double integral = t < 1 ? 0 : t < 3 ? 50 * (t - 1) * (t - 1) : 200 + 200 * (t - 3);
        assert_true(fabs((double)born - integral) <= 1.001);
    }
    assert_int_equal(born, 600);
}

static void bursts_come_at_their_time(void **state)
{
    (void)state;
    float rate = 90.0f;
    const struct kiln_burst bursts[] = {once(-0.5, 7), once(0.2, 3), once(0.2 + 0.5 / 60, 4),
                                        once(10.0, 1)};
    struct kiln_births_source source = at_60_hz(&rate);
    source.bursts = bursts;
    source.burst_count = 4;
    source.warmup_steps = 60;
    uint64_t wait = 0;
    uint32_t total = 0;
    struct kiln_births births;
    for (uint32_t step = 1; step <= 120; step++) {
        kiln_births_step(&source, step, &wait, &births);
        total += births.count;
        uint32_t sum = 0;
        for (uint32_t g = 0; g < births.group_count; g++)
            sum += births.groups[g].count;
        assert_int_equal(sum, births.count);
        if (step == 31) { /* -0.5 s is 30 steps into the run */
            assert_int_equal(births.groups[births.group_count - 1].count, 7);
            assert_int_equal(births.groups[births.group_count - 1].first, 0);
        }
        if (step == 73) { /* both later ones fall into the step that starts at 0.2 s */
            assert_int_equal(births.group_count, 3);
            assert_int_equal(births.groups[1].count, 3);
            assert_int_equal(births.groups[1].first, 0);
            assert_int_equal(births.groups[2].count, 4);
            assert_int_equal(births.groups[2].first, 0x80000000u);
        }
    }
    assert_int_equal(total, 180 + 7 + 3 + 4);
}

/* What a source does in one run: the times and counts of all bursts, in their order. */
struct run_of_bursts {
    double time_s[1000];
    uint32_t count[1000], bursts;
};

static struct run_of_bursts run_bursts(const struct kiln_burst *burst, uint32_t key,
                                       uint32_t steps_a_second, uint32_t seconds)
{
    static const float none = 0.0f;
    struct kiln_births_source source = at_60_hz(&none);
    source.bursts = burst;
    source.burst_count = 1;
    source.random_key = key;
    source.steps_num = steps_a_second;
    source.warmup_steps = steps_a_second;
    struct run_of_bursts run = {.bursts = 0};
    uint64_t wait = 0;
    for (uint32_t step = 1; step <= (seconds + 1) * steps_a_second; step++) {
        struct kiln_births births;
        kiln_births_step(&source, step, &wait, &births);
        for (uint32_t g = 0; g < births.group_count && run.bursts < 1000; g++) {
            run.time_s[run.bursts] = birth_time(step, &births.groups[g], 0) / steps_a_second - 1;
            run.count[run.bursts++] = births.groups[g].count;
        }
    }
    return run;
}

static void repeated_bursts_come_every_so_often(void **state)
{
    (void)state;
    struct kiln_burst burst = {.time_s = -0.25, .count = {5, 5}, .every_s = 0.1, .most = 7};
    struct run_of_bursts run = run_bursts(&burst, 1, 60, 4);
    assert_int_equal(run.bursts, 7);
    for (uint32_t k = 0; k < run.bursts; k++) {
        assert_int_equal(run.count[k], 5);
        assert_true(fabs(run.time_s[k] - (-0.25 + 0.1 * k)) <= 0.5 / 64 / 60 + 1e-9);
    }
    burst.most = UINT32_MAX; /* to the end: 4.25 s */
    assert_int_equal(run_bursts(&burst, 1, 60, 4).bursts, 43);
    burst.every_s = 0.003; /* several in a step of 1/60 s */
    assert_int_equal(run_bursts(&burst, 1, 60, 2).bursts, 751 - 1);
    burst.time_s = -5.0; /* those before the run do not happen */
    burst.every_s = 0.5;
    assert_int_equal(run_bursts(&burst, 1, 60, 2).bursts, 6);
}

/* Numbers are uniform, each repetition has its own, and neither steps nor delays change them. */
static void counts_are_drawn(void **state)
{
    (void)state;
    struct kiln_burst burst = {
        .count = {20, 30}, .every_s = 0.25, .most = UINT32_MAX, .jitter_s = 0.0};
    const struct run_of_bursts run = run_bursts(&burst, 7, 60, 249);
    const struct run_of_bursts other = run_bursts(&burst, 8, 60, 249);
    burst.jitter_s = 0.25;
    const struct run_of_bursts coarse = run_bursts(&burst, 7, 30, 249);
    uint32_t seen[11] = {0}, differ = 0;
    double sum = 0;
    assert_int_equal(run.bursts, 996);
    for (uint32_t k = 0; k < run.bursts; k++) {
        assert_in_range(run.count[k], 20, 30);
        seen[run.count[k] - 20]++;
        sum += run.count[k];
        differ += run.count[k] != other.count[k];
        if (k < coarse.bursts)
            assert_int_equal(run.count[k], coarse.count[k]);
    }
    for (uint32_t i = 0; i < 11; i++)
        assert_in_range(seen[i], 60, 125); /* 91 each: four standard deviations */
    assert_true(fabs(sum / run.bursts - 25.0) < 0.4);
    assert_true(differ > 800);
}

static void delays_are_drawn(void **state)
{
    (void)state;
    const struct kiln_burst burst = {
        .count = {1, 1}, .every_s = 0.25, .most = UINT32_MAX, .jitter_s = 0.2};
    const struct run_of_bursts run = run_bursts(&burst, 3, 60, 249);
    double sum = 0, least = 1, most = 0;
    assert_int_equal(run.bursts, 996);
    for (uint32_t k = 0; k < run.bursts; k++) {
        const double delay = run.time_s[k] - 0.25 * k;
        assert_true(delay > -0.5 / 64 / 60 - 1e-9 && delay < 0.2 + 0.5 / 64 / 60);
        sum += delay;
        least = fmin(least, delay);
        most = fmax(most, delay);
    }
    assert_true(least < 0.002 && most > 0.198);
    assert_true(fabs(sum / run.bursts - 0.1) < 0.006);
}

/* A step has room for 64 bursts; the bound says which step has more. */
static void a_crowded_step_is_found(void **state)
{
    (void)state;
    static const float rate = 600.0f;
    struct kiln_burst burst = {.time_s = 0.1, .count = {1, 1}, .every_s = 0.001, .most = 64};
    struct kiln_births_source source = at_60_hz(&rate);
    source.steps_num = 10;
    source.bursts = &burst;
    source.burst_count = 1;
    assert_int_equal(kiln_births_bound(&source, 20, 1).crowded, 0);
    assert_int_equal(kiln_births_bound(&source, 20, 1).total, 1200 + 64);
    burst.most = 65;
    assert_int_equal(kiln_births_bound(&source, 20, 1).crowded, 2);
    /* bursts of no particles take no room */
    struct kiln_burst both[2] = {burst, burst};
    both[0].most = 64;
    both[1].count[0] = both[1].count[1] = 0;
    source.bursts = both;
    source.burst_count = 2;
    assert_int_equal(kiln_births_bound(&source, 20, 1).crowded, 0);
}

static void senseless_rates_give_no_births(void **state)
{
    (void)state;
    static const float rates[] = {0.0f, -1.0f, NAN};
    for (size_t r = 0; r < sizeof rates / sizeof *rates; r++) {
        struct kiln_births_source source = at_60_hz(&rates[r]);
        struct kiln_births_bound bound =
            kiln_births_bound(&source, 100, kiln_births_lifespan(1.0f, 1.0f / 60.0f, 100));
        assert_int_equal(bound.capacity, 0);
        assert_int_equal(bound.total, 0);
    }
    float endless = INFINITY;
    struct kiln_births_source source = at_60_hz(&endless);
    uint64_t wait = 0;
    struct kiln_births births;
    kiln_births_step(&source, 1, &wait, &births);
    assert_int_equal(births.count, (uint32_t)ceil(2147483648.0 / 60.0));
}

/* The bound against counting every window of a run with bursts and a keyed rate. */
static void the_bound_is_the_fullest_window(void **state)
{
    (void)state;
    enum { STEPS = 400 };
    const struct kiln_burst bursts[] = {once(0.5, 40), once(1.4, 500), once(3.4, 300)};
    struct kiln_births_source source = {.rate = ramp_rate,
                                        .bursts = bursts,
                                        .burst_count = 3,
                                        .steps_num = 60,
                                        .steps_den = 1,
                                        .warmup_steps = 20};
    uint32_t counts[STEPS + 1];
    uint64_t wait = 0, total = 0;
    for (uint32_t step = 1; step <= STEPS; step++) {
        struct kiln_births births;
        kiln_births_step(&source, step, &wait, &births);
        counts[step] = births.count;
        total += births.count;
    }
    static const float lives[] = {0.0f, 0.01f, 1.0f / 60.0f, 0.5f, 1.0f, 2.5f, 100.0f};
    const float dt_s = 1.0f / 60.0f;
    for (size_t l = 0; l < sizeof lives / sizeof *lives; l++) {
        uint32_t window = 1;
        while (window <= STEPS && (float)(window - 1) * dt_s < lives[l])
            window++;
        uint64_t most = 0;
        for (uint32_t first = 1; first <= STEPS; first++) {
            uint64_t sum = 0;
            for (uint32_t k = first; k < first + window && k <= STEPS; k++)
                sum += counts[k];
            most = sum > most ? sum : most;
        }
        struct kiln_births_bound bound =
            kiln_births_bound(&source, STEPS, kiln_births_lifespan(lives[l], dt_s, STEPS));
        assert_int_equal(bound.total, total);
        assert_int_equal(bound.capacity, most);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(five_a_second_come_every_fifth_of_a_second),
        cmocka_unit_test(births_lie_where_the_integral_is_whole),
        cmocka_unit_test(keyed_rates_are_integrated),
        cmocka_unit_test(bursts_come_at_their_time),
        cmocka_unit_test(repeated_bursts_come_every_so_often),
        cmocka_unit_test(counts_are_drawn),
        cmocka_unit_test(delays_are_drawn),
        cmocka_unit_test(a_crowded_step_is_found),
        cmocka_unit_test(senseless_rates_give_no_births),
        cmocka_unit_test(the_bound_is_the_fullest_window),
    };
    return cmocka_run_group_tests_name("births", tests, NULL, NULL);
}
