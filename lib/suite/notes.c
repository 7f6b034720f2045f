/* Notes what a tester should know although nothing failed, such as limits that are too loose. A
 * limit that is far above all that was ever measured hides the fault that it is there to find. */
#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "compare/metric.h"
#include "suite/trial.h"

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
static bool worst_measured(const struct kiln_trial *trial, size_t column, double *worst)
{
    const struct kiln_result *result = trial->result;
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
    for (size_t i = 0; i < trial->expect->measured_count; i++) {
        const struct kiln_expect_value *value = &trial->expect->measured[i];
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
static void note_missing_limits(struct kiln_trial *trial, const struct kiln_metric_set *defaults)
{
    for (size_t i = 0; i < defaults->count; i++) {
        const struct kiln_compare_column *usual = &defaults->columns[i];
        const struct kiln_compare_column *own = NULL;
        for (size_t k = 0; k < trial->result->column_count; k++) {
            if (strcmp(trial->result->columns[k].name, usual->name) == 0)
                own = &trial->result->columns[k];
        }
        if (usual->limited && (!own || !own->limited))
            kiln_trial_note(
                trial,
                "%s has no limit, although its default limit is %.4g, and no reason is given",
                usual->name, usual->limit);
    }
}

/* Notes settings that make the count of differing pixels smaller. */
static void note_settings(struct kiln_trial *trial)
{
    const struct kiln_compare_params usual = kiln_compare_defaults();
    const struct kiln_test *test = trial->test;
    if (test->threshold > usual.threshold)
        kiln_trial_note(
            trial, "threshold %.4g is above the default threshold, %.4g, and no reason is given",
            test->threshold, usual.threshold);
    if (test->window > usual.window)
        kiln_trial_note(trial, "window %u is above the default window, %u, and no reason is given",
                        test->window, usual.window);
}

static void note_limits(struct kiln_trial *trial)
{
    static const char *const default_limits[] = {KILN_COMPARE_DEFAULT_LIMITS};
    const struct kiln_result *result = trial->result;
    struct kiln_metric_set defaults;
    struct kiln_error error = {0};
    const char *own = trial->expect->reason, *test = trial->test->limits_reason;
    bool reason = (own && *own) || (test && *test);
    if (!reason)
        note_settings(trial);
    if (!trial->own_limits || !kiln_metric_set_make(&defaults, default_limits, 1, &error))
        return;
    if (!reason)
        note_missing_limits(trial, &defaults);
    for (size_t i = 0; i < result->column_count; i++) {
        const struct kiln_compare_column *c = &result->columns[i];
        const struct kiln_compare_column *usual = find_column(&defaults, c->name);
        if (!c->limited || !usual || !usual->limited ||
            distance(c, c->limit) <= distance(c, usual->limit))
            continue;
        double worst = 0;
        if (worst_measured(trial, i, &worst) &&
            distance(c, c->limit) > STALE_FACTOR * distance(c, worst))
            kiln_trial_note(trial, "limit %s=%.4g is stale: no value %s %.4g was ever measured",
                            c->name, c->limit, c->higher_is_better ? "below" : "above", worst);
        if (!reason)
            kiln_trial_note(
                trial,
                "limit %s=%.4g is looser than the default limit, %.4g, and no reason is given",
                c->name, c->limit, usual->limit);
    }
}

static void note_states(struct kiln_trial *trial)
{
    const struct kiln_result *result = trial->result;
    char list[256] = "";
    size_t used = 0, count = 0;
    for (size_t i = 0; i < result->frame_count; i++) {
        const struct kiln_result_frame *frame = &result->frames[i];
        if (!trial->frames[i].has_golden || *frame->state_expected ||
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
        kiln_trial_note(trial, "no state is accepted for frame%s %s: --update all adds it",
                        count > 1 ? "s" : "", list);
}

static void note_scene(struct kiln_trial *trial)
{
    const struct kiln_result *result = trial->result;
    bool passes = result->status == KILN_TEST_PASS || result->status == KILN_TEST_WARN;
    if (!passes || !*result->scene_hash_expected ||
        strcmp(result->scene_hash, result->scene_hash_expected) == 0)
        return;
    if (result->change_count > 0)
        kiln_trial_note(trial, "the scene has changed in %zu key%s, and the test passes",
                        result->change_count, result->change_count > 1 ? "s" : "");
    else if (!trial->other_keys) /* other keys give another hash of the same scene */
        kiln_trial_note(trial, "the scene or a file that it uses has changed, and the test passes");
}

/* Returns whether a golden belongs to a frame of the test: its name has the frame's number and the
 * suffix of the test's format. */
static bool is_used(const struct kiln_trial *trial, const char *name)
{
    const char *suffix = kiln_test_suffix(trial->test);
    if (trial->test->kept == KILN_GOLDEN_HASH)
        return false;
    size_t length = strlen(name), end = strlen(suffix);
    if (length < end || strcmp(name + length - end, suffix) != 0)
        return false;
    for (size_t i = 0; i < trial->result->frame_count; i++) {
        char start[32];
        size_t begin =
            (size_t)snprintf(start, sizeof start, "frame_%04u", trial->result->frames[i].number);
        if (strncmp(name, start, begin) == 0 && strchr(".@~", name[begin]))
            return true;
    }
    return false;
}

/* Notes goldens that belong to no frame of the test, as after a frame was removed from its list. */
static void note_unused(struct kiln_trial *trial)
{
    struct dirent **entries = NULL;
    int count = scandir(trial->test->golden, &entries, NULL, alphasort);
    const char *first = NULL;
    int unused = 0;
    for (int i = 0; i < count; i++) {
        const char *name = entries[i]->d_name, *suffix = strrchr(name, '.');
        if (strncmp(name, "frame_", 6) != 0 || !suffix ||
            (strcmp(suffix, ".png") != 0 && strcmp(suffix, ".exr") != 0) || is_used(trial, name))
            continue;
        first = first ? first : name;
        unused++;
    }
    if (unused == 1)
        kiln_trial_note(trial, "%s/%s is a golden of a frame that the test does not have",
                        trial->test->golden, first);
    else if (unused > 1)
        kiln_trial_note(trial,
                        "%s/%s and %d more are goldens of frames that the test does not have",
                        trial->test->golden, first, unused - 1);
    for (int i = 0; i < count; i++)
        free(entries[i]);
    free(entries);
}

void kiln_trial_take_notes(struct kiln_trial *trial)
{
    const struct kiln_result *result = trial->result;
    note_limits(trial);
    if (!trial->params->ignore_hashes)
        note_states(trial);
    note_scene(trial);
    note_unused(trial);
    if (*result->techniques_expected &&
        strcmp(result->techniques, result->techniques_expected) != 0)
        kiln_trial_note(trial, "the techniques are %s, but %s were accepted", result->techniques,
                        result->techniques_expected);
}
