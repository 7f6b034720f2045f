/* Provides what the files of a trial share: texts, notes, paths, limits and masks, and comparisons
 * with goldens. */
#include "suite/trial.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "compare/metric.h"

enum { TEXT_SIZE = 2 * KILN_MESSAGE_SIZE };

static const char *format_text(struct kiln_trial *trial, const char *format, va_list arguments)
{
    char text[TEXT_SIZE + KILN_PATH_SIZE];
    vsnprintf(text, sizeof text, format, arguments);
    const char *copy = kiln_arena_text(trial->arena, text, strlen(text));
    trial->no_memory = trial->no_memory || !copy;
    return copy ? copy : "";
}

const char *kiln_trial_text(struct kiln_trial *trial, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const char *text = format_text(trial, format, arguments);
    va_end(arguments);
    return text;
}

void kiln_trial_note(struct kiln_trial *trial, const char *format, ...)
{
    struct kiln_result *result = trial->result;
    if (result->note_count == trial->note_capacity) {
        size_t capacity = trial->note_capacity ? 2 * trial->note_capacity : 16;
        const char **notes = kiln_arena_alloc(trial->arena, capacity, sizeof *notes);
        if (!notes) {
            trial->no_memory = true;
            return;
        }
        if (result->note_count > 0)
            memcpy(notes, result->notes, result->note_count * sizeof *notes);
        result->notes = notes;
        trial->note_capacity = capacity;
    }
    va_list arguments;
    va_start(arguments, format);
    result->notes[result->note_count++] = format_text(trial, format, arguments);
    va_end(arguments);
}

bool kiln_trial_path(const struct kiln_trial *trial, const char *file, char path[KILN_PATH_SIZE],
                     struct kiln_error *error)
{
    return kiln_path_join(path, trial->test->results, file, error);
}

/* ---- Limits ------------------------------------------------------------------------------- */

static bool collect_limits(struct kiln_trial *trial)
{
    const struct kiln_test *test = trial->test;
    const struct kiln_expect *expect = trial->expect;
    size_t capacity = 1 + test->limit_count + expect->limit_count;
    trial->limits = kiln_arena_alloc(trial->arena, capacity, sizeof *trial->limits);
    if (!trial->limits)
        return false;
    if (test->limit_count == 0)
        trial->limits[trial->limit_count++] = KILN_COMPARE_DEFAULT_LIMITS;
    for (size_t i = 0; i < test->limit_count; i++)
        trial->limits[trial->limit_count++] = test->limits[i];
    for (size_t i = 0; i < expect->limit_count; i++) {
        char value[32];
        kiln_text_from_double(value, expect->limits[i].value);
        trial->limits[trial->limit_count++] =
            kiln_trial_text(trial, "%s=%s", expect->limits[i].metric, value);
    }
    trial->own_limits = test->limit_count + expect->limit_count > 0;
    return !trial->no_memory;
}

static void add_mask(struct kiln_trial *trial, const struct kiln_test_mask *mask)
{
    trial->masks[trial->mask_count++] =
        (struct kiln_compare_mask){sizeof *trial->masks, mask->rect[0], mask->rect[1],
                                   mask->rect[2],        mask->rect[3], mask->picture};
}

bool kiln_trial_set_limits(struct kiln_trial *trial, struct kiln_error *error)
{
    const struct kiln_test *test = trial->test;
    const struct kiln_expect *expect = trial->expect;
    struct kiln_metric_set set;
    trial->warn = expect->warn >= 0 ? expect->warn : test->warn;
    trial->result->warn = trial->warn;
    trial->masks = kiln_arena_alloc(trial->arena, test->mask_count + expect->mask_count + 1,
                                    sizeof *trial->masks);
    if (!trial->masks || !collect_limits(trial))
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", test->path);
    for (size_t i = 0; i < test->mask_count; i++)
        add_mask(trial, &test->masks[i]);
    for (size_t i = 0; i < expect->mask_count; i++)
        add_mask(trial, &expect->masks[i]);
    if (!kiln_metric_set_make(&set, trial->limits, trial->limit_count, error))
        return false;
    trial->result->column_count = set.count;
    memcpy(trial->result->columns, set.columns, sizeof set.columns);
    return true;
}

/* ---- Comparing ---------------------------------------------------------------------------- */

static void take_frame(void *user, const struct kiln_compare_result *result,
                       const struct kiln_compare_frame *frame)
{
    (void)result;
    struct kiln_trial_comparison *comparison = user;
    comparison->frame = *frame;
    snprintf(comparison->message, sizeof comparison->message, "%s", frame->message);
    comparison->frame.name = comparison->frame.message = "";
}

bool kiln_trial_compare(const struct kiln_trial *trial, const char *golden, const char *picture,
                        const char *error_map, struct kiln_trial_comparison *comparison,
                        struct kiln_error *error)
{
    *comparison = (struct kiln_trial_comparison){0};
    struct kiln_compare_params params = kiln_compare_defaults();
    params.reference = golden;
    params.test = picture;
    params.limits = trial->limits;
    params.limit_count = trial->limit_count;
    params.threshold = trial->test->threshold;
    params.window = trial->test->window;
    params.threads = trial->params->threads;
    params.error_map = error_map;
    params.masks = trial->masks;
    params.mask_stride = sizeof *trial->masks;
    params.mask_count = trial->mask_count;
    params.overwrite = true;
    params.frame = take_frame;
    params.user = comparison;
    comparison->result = kiln_compare_result_empty();
    bool ok = kiln_compare(&params, &comparison->result, error);
    if (ok && !comparison->frame.measured)
        comparison->frame.score = INFINITY;
    return ok;
}
