/* Writes numbers, counts and summaries in the form that several formats of reports share. */
#include "report/text.h"

#include <inttypes.h>
#include <math.h>

#include "base/text.h"

void kiln_report_text_number(char out[32], double value)
{
    double rounded = value;
    if (isfinite(value) && value != 0) { /* to four digits */
        double unit = pow(10, floor(log10(fabs(value))) - 3);
        double steps = round(value / unit);
        rounded = isfinite(steps) ? steps * unit : value;
    }
    kiln_text_from_float(out, (float)rounded);
}

void kiln_report_text_seconds(char out[32], double seconds)
{
    double most = 1e12;
    uint64_t ms = seconds > 0 ? (uint64_t)round((seconds < most ? seconds : most) * 1000) : 0;
    snprintf(out, 32, "%" PRIu64 ".%03" PRIu64, ms / 1000, ms % 1000);
}

/* Writes by what frames were judged: "66 by pixels, 1 by metrics". These two counts are always
 * written, since a reader judges a run by them; the others are written if they are not 0. */
static void write_judges(FILE *out, const struct kiln_results_frames *frames)
{
    const uint32_t judged = frames->by_pixels + frames->by_metrics + frames->by_state;
    fprintf(out, "%u by pixels, %u by metrics", frames->by_pixels, frames->by_metrics);
    if (frames->by_state > 0)
        fprintf(out, ", %u by state", frames->by_state);
    if (frames->all > judged)
        fprintf(out, ", %u by nothing", frames->all - judged);
}

bool kiln_write_frames(FILE *out, const struct kiln_results_summary *summary)
{
    const struct kiln_results_frames *frames = &summary->frames, *gl = &summary->gl_frames;
    fprintf(out, "%u frame%s: ", frames->all, frames->all == 1 ? "" : "s");
    write_judges(out, frames);
    if (gl->all > 0) {
        fprintf(out, "; %u of tests that pin GL: ", gl->all);
        write_judges(out, gl);
    }
    return !ferror(out);
}

void kiln_report_text_summary(char out[256], const struct kiln_results *results)
{
    struct kiln_results_summary summary = kiln_results_summary(results);
    char seconds[32];
    kiln_report_text_seconds(seconds, summary.total_s);
    int length = snprintf(out, 256, "%u %s", summary.tests, summary.tests == 1 ? "test" : "tests");
    const char *before = ": ";
    for (int i = 0; i < KILN_TEST_STATUS_COUNT; i++) {
        if (summary.counts[i] == 0)
            continue;
        length += snprintf(out + length, 256 - (size_t)length, "%s%u %s", before, summary.counts[i],
                           kiln_test_status_name((enum kiln_test_status)i));
        before = ", ";
    }
    snprintf(out + length, 256 - (size_t)length, "; in %s s", seconds);
}

bool kiln_report_worst_value(const struct kiln_result *result, size_t column, double *value)
{
    bool found = false, higher = result->columns[column].higher_is_better;
    for (size_t i = 0; i < result->frame_count; i++) {
        const struct kiln_result_frame *frame = &result->frames[i];
        if (!frame->measured)
            continue;
        double v = frame->values[column];
        if (!found || (higher ? v < *value : v > *value))
            *value = v;
        found = true;
    }
    return found;
}
