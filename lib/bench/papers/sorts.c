/* Runs the suite `table1` of `kiln bench`, which measures table 1 of UberFlow (Kipfer, Segal and
 * Westermann 2004). A field of n x n keys is sorted by every technique, and by the paper's bitonic
 * sort, whose comparator's constants are computed (FP), passed in (GP/FP) or passed in for packed
 * pairs. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "bench/papers/papers.h"
#include "bench/papers/sort_timer.h"
#include "shared/random.h"

/* Numbers of rows of the last entrants. These sort packed pairs within sets of that many rows
 * (UberFlow, 5); the other entrants are the kinds of timers. */
static const uint32_t ROWS[] = {1, 16};

enum {
    RESTRICTED = sizeof ROWS / sizeof *ROWS,
    ENTRANTS = KILN_SORT_TIMER_COUNT + RESTRICTED,
};

struct sort_bench {
    const struct kiln_bench_run *run;
    struct kiln_threads *threads;
    uint32_t *keys;
    uint32_t count;
    struct kiln_lane lanes[ENTRANTS]; /* only their names are used */
    struct kiln_sort_timer *timers[ENTRANTS];
    struct kiln_samples *samples; /* [ENTRANTS] */
};

/* Returns whether the device allows this kind of sort at all. */
static bool may_sort(const struct sort_bench *sort_bench, enum kiln_sort_timer_kind kind,
                     struct kiln_error *error)
{
    static const char *const flag = "sort=bitonic";
    struct kiln_techniques unused;
    return kind == KILN_SORT_TIMER_CPU ||
           kiln_techniques_choose(kiln_device_get_info(sort_bench->run->device), &flag, 1, &unused,
                                  error);
}

static bool enter(struct sort_bench *sort_bench, size_t index, struct kiln_error *error)
{
    bool restricted = index >= KILN_SORT_TIMER_COUNT;
    enum kiln_sort_timer_kind kind =
        restricted ? KILN_SORT_TIMER_PACKED : (enum kiln_sort_timer_kind)index;
    const char *name = kiln_sort_timer_name(kind);
    uint32_t rows = restricted ? ROWS[index - KILN_SORT_TIMER_COUNT] : 0;
    sort_bench->lanes[index] = (struct kiln_lane){
        .name = restricted ? kiln_arena_format(sort_bench->run->bench->arena, "%s, %u row%s", name,
                                               rows, rows == 1 ? "" : "s")
                           : name};
    if (!sort_bench->lanes[index].name) {
        kiln_error_no_memory(error, "measurements");
        return false;
    }
    if (may_sort(sort_bench, kind, error))
        sort_bench->timers[index] = kiln_sort_timer_create(
            sort_bench->run->device, sort_bench->threads, kind, sort_bench->count, error);
    if (!sort_bench->timers[index])
        return kiln_lane_is_refused(sort_bench->run, error, &sort_bench->samples[index].problem);
    kiln_sort_timer_restrict(sort_bench->timers[index], rows);
    return true;
}

static bool may_go_on(const struct kiln_bench_run *run, struct kiln_error *error)
{
    const struct kiln_bench_params *params = run->params;
    return !params->stop || !params->stop(params->user) ||
           kiln_error_set(error, KILN_INTERRUPTED, "stopped");
}

/* Runs all entrants in turn. The first turn only warms up. */
static bool take_turns(struct sort_bench *sort_bench, struct kiln_error *error)
{
    double spent_ms = 0.0;
    for (uint32_t turn = 0; turn <= sort_bench->run->bench->repetitions; turn++) {
        if (turn > KILN_BENCH_MIN_REPETITIONS && spent_ms > 1e3 * sort_bench->run->params->seconds)
            return true;
        for (size_t i = 0; i < ENTRANTS; i++) {
            struct kiln_samples *samples = &sort_bench->samples[i];
            double ms = 0.0;
            if (!sort_bench->timers[i])
                continue;
            if (!may_go_on(sort_bench->run, error) ||
                !kiln_sort_timer_run(sort_bench->timers[i], sort_bench->keys, sort_bench->count,
                                     &ms, error))
                return false;
            if (turn > 0)
                samples->ms[KILN_PASS_sort][samples->count++] = ms;
            spent_ms += turn > 0 ? ms : 0.0;
        }
    }
    return true;
}

static bool set_up(struct sort_bench *sort_bench, struct kiln_error *error)
{
    sort_bench->threads = kiln_threads_create(sort_bench->run->params->threads);
    sort_bench->keys = calloc(sort_bench->count, sizeof *sort_bench->keys);
    sort_bench->samples = calloc(ENTRANTS, sizeof *sort_bench->samples);
    if (!sort_bench->threads || !sort_bench->keys || !sort_bench->samples)
        return kiln_error_no_memory(error, "measurements");
    for (uint32_t i = 0; i < sort_bench->count; i++)
        sort_bench->keys[i] = random_mix(i);
    for (size_t i = 0; i < ENTRANTS; i++) {
        if (!enter(sort_bench, i, error))
            return false;
    }
    return true;
}

static bool run_side(const struct kiln_bench_run *run, double side, struct kiln_error *error)
{
    struct sort_bench sort_bench = {.run = run, .count = (uint32_t)(side * side)};
    bool ok = set_up(&sort_bench, error) && take_turns(&sort_bench, error);
    const struct kiln_comparison comparison = {.lanes = sort_bench.lanes,
                                               .lane_count = ENTRANTS,
                                               .measures = KILN_MEASURE(sort),
                                               .x = side,
                                               .rates = true};
    ok = ok && kiln_bench_add_samples(run, &comparison, sort_bench.samples, error);
    for (size_t i = 0; i < ENTRANTS; i++)
        kiln_sort_timer_destroy(&sort_bench.timers[i]);
    free(sort_bench.samples);
    free(sort_bench.keys);
    kiln_threads_destroy(&sort_bench.threads);
    return ok;
}

static bool publish(const struct kiln_bench_run *run, size_t size, double side,
                    struct kiln_error *error)
{
    static const struct {
        const char *name;
        double rates[4];
    } rows[] = {
        {"FP (2004)", {22, 3.5, 1, 0.2}},
        {"GP/FP (2004)", {40, 10, 3, 0.4}},
        {"GP/FP Packed (2004)", {148, 43, 10, 2}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (!kiln_bench_publish(run, side, "sort", rows[i].name, rows[i].rates[size],
                                KILN_UBERFLOW_SOURCE, error))
            return false;
    }
    return true;
}

bool kiln_suite_table_1(const struct kiln_bench_run *run, struct kiln_error *error)
{
    static const double sides[] = {128, 256, 512, 1024};
    const struct kiln_bench_part part = {
        .name = "table1",
        .title = "UberFlow, table 1: sorting n x n pairs of random keys",
        .sweep = "n",
        .unit = "fps",
        .reference = kiln_sort_timer_name(KILN_SORT_TIMER_CPU),
        .plotted = true,
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    size_t count = run->params->quick ? 1 : sizeof sides / sizeof *sides;
    for (size_t i = 0; i < count; i++) {
        kiln_bench_say(run, "%.0f x %.0f keys", sides[i], sides[i]);
        if (!run_side(run, sides[i], error) || !publish(run, i, sides[i], error))
            return false;
    }
    return kiln_bench_add_note(
        run->bench, error,
        "FP is bitonic-computed, GP/FP is bitonic-passed. The published times include the making "
        "of the keys and the moving of the particles. Sets of rows are sorted apart (5).");
}
