/* Notes what a tester should know although nothing failed, such as limits that are too loose. A
 * limit that is far above all that was ever measured hides the fault that it is there to find. */
#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "compare/metric.h"
#include "suite/test_case.h"

enum { STALE_FACTOR = 10 };

/* Returns how far a value is from that of equal pictures, on a linear scale, so that distances can
 * be divided by each other. Decibels are converted. */
static double distance(const struct kiln_compare_column *column, double value)
{
    if (strcmp(column->unit, "dB") == 0)
        return pow(10.0, -value / 20.0);
    return column->higher_is_better ? 1.0 - value : value;
}

static const struct kiln_compare_column *find_column(const struct kiln_metric_set *set,
                                                     const char *name)
{
    for (size_t i = 0; i < set->count; i++) {
        if (strcmp(set->columns[i].name, name) == 0)
            return &set->columns[i];
    }
    return NULL;
}

/* Finds the worst value that this run or a calibration measured; false when neither did. */
static bool worst_measured(const struct kiln_test_case *test_case, size_t column, double *worst)
{
    const struct kiln_result *result = test_case->result;
    const struct kiln_compare_column *c = &result->columns[column];
    bool found = false;
    for (size_t i = 0; i < result->frame_count; i++) {
        const struct kiln_result_frame *frame = &result->frames[i];
        if (!frame->measured)
            continue;
        if (!found || distance(c, frame->values[column]) > distance(c, *worst))
            *worst = frame->values[column];
        found = true;
    }
    for (size_t i = 0; i < test_case->expect->measured_count; i++) {
        const struct kiln_expect_value *value = &test_case->expect->measured[i];
        if (strcmp(value->metric, c->name) != 0)
            continue;
        if (!found || distance(c, value->value) > distance(c, *worst))
            *worst = value->value;
        found = true;
    }
    return found;
}

/* Notes metrics that have a limit by default and none in this test. The test's limits replace the
 * default ones, so a metric without a limit may have any value. */
static void note_missing_limits(struct kiln_test_case *test_case,
                                const struct kiln_metric_set *defaults)
{
    for (size_t i = 0; i < defaults->count; i++) {
        const struct kiln_compare_column *default_column = &defaults->columns[i];
        const struct kiln_compare_column *column = NULL;
        for (size_t k = 0; k < test_case->result->column_count; k++) {
            if (strcmp(test_case->result->columns[k].name, default_column->name) == 0)
                column = &test_case->result->columns[k];
        }
        if (default_column->limited && (!column || !column->limited))
            kiln_test_case_note(
                test_case,
                "%s has no limit, although its default limit is %.4g, and no reason is given",
                default_column->name, default_column->limit);
    }
}

/* Notes settings that make the count of differing pixels smaller. */
static void note_settings(struct kiln_test_case *test_case)
{
    const struct kiln_compare_params defaults = kiln_compare_defaults();
    const struct kiln_test *test = test_case->test;
    if (test->threshold > defaults.threshold)
        kiln_test_case_note(
            test_case,
            "threshold %.4g is above the default threshold, %.4g, and no reason is given",
            test->threshold, defaults.threshold);
    if (test->window > defaults.window)
        kiln_test_case_note(test_case,
                            "window %u is above the default window, %u, and no reason is given",
                            test->window, defaults.window);
}

static void note_limits(struct kiln_test_case *test_case)
{
    static const char *const default_limits[] = {KILN_COMPARE_DEFAULT_LIMITS};
    const struct kiln_result *result = test_case->result;
    struct kiln_metric_set defaults;
    struct kiln_error error = {0};
    const char *expect_reason = test_case->expect->reason;
    const char *test_reason = test_case->test->limits_reason;
    bool has_reason = (expect_reason && *expect_reason) || (test_reason && *test_reason);
    if (!has_reason)
        note_settings(test_case);
    if (!test_case->has_own_limits || !kiln_metric_set_make(&defaults, default_limits, 1, &error))
        return;
    if (!has_reason)
        note_missing_limits(test_case, &defaults);
    for (size_t i = 0; i < result->column_count; i++) {
        const struct kiln_compare_column *c = &result->columns[i];
        const struct kiln_compare_column *default_column = find_column(&defaults, c->name);
        if (!c->limited || !default_column || !default_column->limited ||
            distance(c, c->limit) <= distance(c, default_column->limit))
            continue;
        double worst = 0;
        if (worst_measured(test_case, i, &worst) &&
            distance(c, c->limit) > STALE_FACTOR * distance(c, worst))
            kiln_test_case_note(
                test_case, "limit %s=%.4g" KILN_NOTE_STALE ": no value %s %.4g was ever measured",
                c->name, c->limit, c->higher_is_better ? "below" : "above", worst);
        if (!has_reason)
            kiln_test_case_note(
                test_case,
                "limit %s=%.4g is looser than the default limit, %.4g, and no reason is given",
                c->name, c->limit, default_column->limit);
    }
}

static void note_states(struct kiln_test_case *test_case)
{
    const struct kiln_result *result = test_case->result;
    char list[256] = "";
    size_t used = 0, count = 0;
    for (size_t i = 0; i < result->frame_count; i++) {
        const struct kiln_result_frame *frame = &result->frames[i];
        if (!test_case->frames[i].has_golden || *frame->state_expected ||
            frame->status == KILN_TEST_ERROR || frame->status == KILN_TEST_NEW)
            continue;
        if (used < sizeof list) {
            int length =
                snprintf(list + used, sizeof list - used, "%s%u", used ? ", " : "", frame->number);
            used += length > 0 ? (size_t)length : 0;
        }
        count++;
    }
    if (count > 0)
        kiln_test_case_note(test_case, "no state is accepted for frame%s %s: --update all adds it",
                            count > 1 ? "s" : "", list);
}

static void note_scene(struct kiln_test_case *test_case)
{
    const struct kiln_result *result = test_case->result;
    bool passes = result->status == KILN_TEST_PASS || result->status == KILN_TEST_WARN;
    if (!passes || !*result->scene_hash_expected ||
        strcmp(result->scene_hash, result->scene_hash_expected) == 0)
        return;
    if (result->change_count > 0)
        kiln_test_case_note(test_case, "the scene has changed in %zu key%s, and the test passes",
                            result->change_count, result->change_count > 1 ? "s" : "");
    else if (!test_case->scene_keys_differ) /* other keys give another hash of the same scene */
        kiln_test_case_note(test_case,
                            "the scene or a file that it uses has changed, and the test passes");
}

/* Returns whether a golden belongs to a frame of the test: its name has the frame's number and the
 * suffix of the test's format. */
static bool is_used(const struct kiln_test_case *test_case, const char *name)
{
    const char *suffix = kiln_test_suffix(test_case->test);
    if (test_case->test->golden_form == KILN_GOLDEN_HASH)
        return false;
    size_t length = strlen(name), end = strlen(suffix);
    if (length < end || strcmp(name + length - end, suffix) != 0)
        return false;
    for (size_t i = 0; i < test_case->result->frame_count; i++) {
        char start[32];
        size_t begin = (size_t)snprintf(start, sizeof start, "frame_%04u",
                                        test_case->result->frames[i].number);
        if (strncmp(name, start, begin) == 0 && strchr(".@~", name[begin]))
            return true;
    }
    return false;
}

/* Notes goldens that belong to no frame of the test, as after a frame was removed from its list. */
static void note_unused(struct kiln_test_case *test_case)
{
    struct dirent **entries = NULL;
    int count = scandir(test_case->test->golden, &entries, NULL, alphasort);
    const char *first = NULL;
    int unused = 0;
    for (int i = 0; i < count; i++) {
        const char *name = entries[i]->d_name, *suffix = strrchr(name, '.');
        if (strncmp(name, "frame_", 6) != 0 || !suffix ||
            (strcmp(suffix, ".png") != 0 && strcmp(suffix, ".exr") != 0) ||
            is_used(test_case, name))
            continue;
        first = first ? first : name;
        unused++;
    }
    if (unused == 1)
        kiln_test_case_note(test_case, "%s/%s is a golden of a frame that the test does not have",
                            test_case->test->golden, first);
    else if (unused > 1)
        kiln_test_case_note(test_case,
                            "%s/%s and %d more are goldens of frames that the test does not have",
                            test_case->test->golden, first, unused - 1);
    for (int i = 0; i < count; i++)
        free(entries[i]);
    free(entries);
}

/* Returns whether a list, whose entries a space parts, has a technique. */
static bool has_technique(const char *list, const char *technique)
{
    const size_t length = strlen(technique);
    for (const char *at = strstr(list, technique); at; at = strstr(at + 1, technique))
        if ((at == list || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0'))
            return true;
    return false;
}

/* Notes that stages run by other techniques than those that were accepted. A stage that the golden
 * does not name is newer than the golden, and says nothing. */
static void note_techniques(struct kiln_test_case *test_case)
{
    const struct kiln_expect *expect = test_case->expect;
    const struct kiln_result *result = test_case->result;
    bool same = true;
    for (size_t i = 0; i < expect->technique_count; i++)
        same &= has_technique(result->techniques, expect->techniques[i]);
    if (!same)
        kiln_test_case_note(test_case, "the techniques are %s, but %s were accepted",
                            result->techniques, result->techniques_expected);
}

void kiln_test_case_take_notes(struct kiln_test_case *test_case)
{
    note_limits(test_case);
    if (!test_case->params->ignore_hashes)
        note_states(test_case);
    note_scene(test_case);
    note_unused(test_case);
    note_techniques(test_case);
}
