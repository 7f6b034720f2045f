/* Runs the suite `table1` of `kiln bench`, which measures table 1 of UberFlow (Kipfer, Segal and
 * Westermann 2004). A field of n x n keys is sorted by every technique, and by the paper's bitonic
 * sort, whose comparator's constants are computed (FP), passed in (GP/FP) or passed in for packed
 * pairs. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "bench/sort_trial.h"
#include "bench/suite.h"
#include "shared/random.h"

/* Numbers of rows of the last entrants. These sort packed pairs within sets of that many rows
 * (UberFlow, 5); the other entrants are the kinds of trials. */
static const uint32_t ROWS[] = {1, 16};

enum {
    RESTRICTED = sizeof ROWS / sizeof *ROWS,
    ENTRANTS = KILN_TRIAL_COUNT + RESTRICTED,
};

struct race {
    const struct kiln_bench_run *run;
    struct kiln_threads *threads;
    uint32_t *keys;
    uint32_t count;
    struct kiln_lane lanes[ENTRANTS]; /* only their names are used */
    struct kiln_sort_trial *trials[ENTRANTS];
    struct kiln_samples *samples; /* [ENTRANTS] */
};

/* Returns whether the device allows this kind of sort at all. */
static bool may_sort(const struct race *race, enum kiln_sort_trial_kind kind,
                     struct kiln_error *error)
{
    static const char *const flag = "sort=bitonic";
    struct kiln_techniques unused;
    return kind == KILN_TRIAL_CPU || kiln_techniques_choose(kiln_device_get_info(race->run->device),
                                                            &flag, 1, &unused, error);
}

static bool enter(struct race *race, size_t index, struct kiln_error *error)
{
    bool restricted = index >= KILN_TRIAL_COUNT;
    enum kiln_sort_trial_kind kind =
        restricted ? KILN_TRIAL_PACKED : (enum kiln_sort_trial_kind)index;
    const char *name = kiln_sort_trial_name(kind);
    uint32_t rows = restricted ? ROWS[index - KILN_TRIAL_COUNT] : 0;
    race->lanes[index] = (struct kiln_lane){
        .name = restricted ? kiln_arena_format(race->run->bench->arena, "%s, %u row%s", name, rows,
                                               rows == 1 ? "" : "s")
                           : name};
    if (!race->lanes[index].name) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for measurements");
        return false;
    }
    if (may_sort(race, kind, error))
        race->trials[index] =
            kiln_sort_trial_create(race->run->device, race->threads, kind, race->count, error);
    if (!race->trials[index])
        return kiln_lane_is_refused(race->run, error, &race->samples[index].problem);
    kiln_sort_trial_restrict(race->trials[index], rows);
    return true;
}

static bool may_go_on(const struct kiln_bench_run *run, struct kiln_error *error)
{
    const struct kiln_bench_params *params = run->params;
    return !params->stop || !params->stop(params->user) ||
           kiln_error_set(error, KILN_INTERRUPTED, "stopped");
}

/* Runs all entrants in turn. The first turn only warms up. */
static bool take_turns(struct race *race, struct kiln_error *error)
{
    double spent_ms = 0.0;
    for (uint32_t turn = 0; turn <= race->run->bench->repetitions; turn++) {
        if (turn > KILN_BENCH_MIN_REPETITIONS && spent_ms > 1e3 * race->run->params->seconds)
            return true;
        for (size_t i = 0; i < ENTRANTS; i++) {
            struct kiln_samples *samples = &race->samples[i];
            double ms = 0.0;
            if (!race->trials[i])
                continue;
            if (!may_go_on(race->run, error) ||
                !kiln_sort_trial_run(race->trials[i], race->keys, race->count, &ms, error))
                return false;
            if (turn > 0)
                samples->ms[KILN_PASS_sort][samples->count++] = ms;
            spent_ms += turn > 0 ? ms : 0.0;
        }
    }
    return true;
}

static bool set_up(struct race *race, struct kiln_error *error)
{
    race->threads = kiln_threads_create(race->run->params->threads);
    race->keys = calloc(race->count, sizeof *race->keys);
    race->samples = calloc(ENTRANTS, sizeof *race->samples);
    if (!race->threads || !race->keys || !race->samples)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for measurements");
    for (uint32_t i = 0; i < race->count; i++)
        race->keys[i] = random_mix(i);
    for (size_t i = 0; i < ENTRANTS; i++) {
        if (!enter(race, i, error))
            return false;
    }
    return true;
}

static bool run_side(const struct kiln_bench_run *run, double side, struct kiln_error *error)
{
    struct race race = {.run = run, .count = (uint32_t)(side * side)};
    bool ok = set_up(&race, error) && take_turns(&race, error);
    const struct kiln_comparison comparison = {.lanes = race.lanes,
                                               .lane_count = ENTRANTS,
                                               .measures = KILN_MEASURE(sort),
                                               .x = side,
                                               .rates = true};
    ok = ok && kiln_bench_add_samples(run, &comparison, race.samples, error);
    for (size_t i = 0; i < ENTRANTS; i++)
        kiln_sort_trial_destroy(&race.trials[i]);
    free(race.samples);
    free(race.keys);
    kiln_threads_destroy(&race.threads);
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
        .reference = kiln_sort_trial_name(KILN_TRIAL_CPU),
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
