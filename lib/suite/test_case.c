/* Provides what the files that run a test case share: texts, notes, paths, limits and masks, and
 * comparisons with goldens. */
#include "suite/test_case.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "compare/metric.h"

enum { TEXT_SIZE = 2 * KILN_MESSAGE_SIZE };

static const char *format_text(struct kiln_test_case *test_case, const char *format,
                               va_list arguments)
{
    char text[TEXT_SIZE + KILN_PATH_SIZE];
    vsnprintf(text, sizeof text, format, arguments);
    const char *copy = kiln_arena_text(test_case->arena, text, strlen(text));
    test_case->no_memory = test_case->no_memory || !copy;
    return copy ? copy : "";
}

const char *kiln_test_case_text(struct kiln_test_case *test_case, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const char *text = format_text(test_case, format, arguments);
    va_end(arguments);
    return text;
}

void kiln_test_case_note(struct kiln_test_case *test_case, const char *format, ...)
{
    struct kiln_result *result = test_case->result;
    if (result->note_count == test_case->note_capacity) {
        size_t capacity = test_case->note_capacity ? 2 * test_case->note_capacity : 16;
        const char **notes = kiln_arena_alloc(test_case->arena, capacity, sizeof *notes);
        if (!notes) {
            test_case->no_memory = true;
            return;
        }
        if (result->note_count > 0)
            memcpy(notes, result->notes, result->note_count * sizeof *notes);
        result->notes = notes;
        test_case->note_capacity = capacity;
    }
    va_list arguments;
    va_start(arguments, format);
    result->notes[result->note_count++] = format_text(test_case, format, arguments);
    va_end(arguments);
}

bool kiln_test_case_path(const struct kiln_test_case *test_case, const char *file,
                         char path[KILN_PATH_SIZE], struct kiln_error *error)
{
    return kiln_path_join(path, test_case->test->results, file, error);
}

/* ---- Limits ------------------------------------------------------------------------------- */

static bool collect_limits(struct kiln_test_case *test_case)
{
    const struct kiln_test *test = test_case->test;
    const struct kiln_expect *expect = test_case->expect;
    size_t capacity = 1 + test->limit_count + expect->limit_count;
    test_case->limits = kiln_arena_alloc(test_case->arena, capacity, sizeof *test_case->limits);
    if (!test_case->limits)
        return false;
    if (test->limit_count == 0)
        test_case->limits[test_case->limit_count++] = KILN_COMPARE_DEFAULT_LIMITS;
    for (size_t i = 0; i < test->limit_count; i++)
        test_case->limits[test_case->limit_count++] = test->limits[i];
    for (size_t i = 0; i < expect->limit_count; i++) {
        char value[32];
        kiln_text_from_double(value, expect->limits[i].value);
        test_case->limits[test_case->limit_count++] =
            kiln_test_case_text(test_case, "%s=%s", expect->limits[i].metric, value);
    }
    test_case->has_own_limits = test->limit_count + expect->limit_count > 0;
    return !test_case->no_memory;
}

static void add_mask(struct kiln_test_case *test_case, const struct kiln_test_mask *mask)
{
    struct kiln_compare_mask *copy = &test_case->masks[test_case->mask_count++];
    *copy = (struct kiln_compare_mask){sizeof *copy,  mask->rect[0], mask->rect[1],
                                       mask->rect[2], mask->rect[3], mask->picture};
}

bool kiln_test_case_set_limits(struct kiln_test_case *test_case, struct kiln_error *error)
{
    const struct kiln_test *test = test_case->test;
    const struct kiln_expect *expect = test_case->expect;
    struct kiln_metric_set set;
    test_case->warn = expect->warn >= 0 ? expect->warn : test->warn;
    test_case->result->warn = test_case->warn;
    test_case->masks = kiln_arena_alloc(test_case->arena, test->mask_count + expect->mask_count + 1,
                                        sizeof *test_case->masks);
    if (!test_case->masks || !collect_limits(test_case))
        return kiln_error_no_memory(error, "%s", test->path);
    for (size_t i = 0; i < test->mask_count; i++)
        add_mask(test_case, &test->masks[i]);
    for (size_t i = 0; i < expect->mask_count; i++)
        add_mask(test_case, &expect->masks[i]);
    if (!kiln_metric_set_make(&set, test_case->limits, test_case->limit_count, error))
        return false;
    test_case->result->column_count = set.count;
    memcpy(test_case->result->columns, set.columns, sizeof set.columns);
    return true;
}

/* ---- Comparing ---------------------------------------------------------------------------- */

static void take_frame(void *user, const struct kiln_compare_result *result,
                       const struct kiln_compare_frame *frame)
{
    (void)result;
    struct kiln_test_case_comparison *comparison = user;
    comparison->frame = *frame;
    snprintf(comparison->message, sizeof comparison->message, "%s", frame->message);
    comparison->frame.name = comparison->frame.message = "";
    comparison->frame.layers = NULL; /* like the texts, they are gone after this call */
    comparison->frame.layer_count = 0;
}

bool kiln_test_case_compare(const struct kiln_test_case *test_case, const char *golden,
                            const char *picture, const char *error_map,
                            struct kiln_test_case_comparison *comparison, struct kiln_error *error)
{
    *comparison = (struct kiln_test_case_comparison){0};
    struct kiln_compare_params params = kiln_compare_defaults();
    params.reference = golden;
    params.test = picture;
    params.layer = "beauty"; /* what the hash of a golden picture is of, too */
    params.limits = test_case->limits;
    params.limit_count = test_case->limit_count;
    params.threshold = test_case->test->threshold;
    params.window = test_case->test->window;
    params.threads = test_case->params->threads;
    params.error_map = error_map;
    params.masks = test_case->masks;
    params.mask_stride = sizeof *test_case->masks;
    params.mask_count = test_case->mask_count;
    params.overwrite = true;
    params.frame = take_frame;
    params.user = comparison;
    comparison->result = kiln_compare_result_empty();
    bool ok = kiln_compare(&params, &comparison->result, error);
    if (ok && !comparison->frame.measured)
        comparison->frame.score = INFINITY;
    return ok;
}
