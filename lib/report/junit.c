/* Writes a report as JUnit XML that Jenkins and GitLab read. A test of kiln becomes a suite with
 * one case: properties describe the test, and a suite is the only element that may have properties
 * in every dialect. The pictures of frames that do not pass are attachments, named by
 * "[[ATTACHMENT|path]]" in the output of the case. A server uploads the file at such a path, so it
 * names none but plain files of the result, and texts cannot contain such a marker. */
#include <string.h>
#include <unistd.h>

#include "base/marker.h"
#include "base/text.h"
#include "report/markup.h"
#include "report/text.h"
#include "suite/result_member.h"

/* ---- XML ---------------------------------------------------------------------------------- */

/* Returns whether a character of valid UTF-8 is written to the document. XML 1.0 forbids most
 * control characters; those from U+007F to U+009F are allowed, but not written either. */
static bool is_allowed(const unsigned char *s)
{
    if (s[0] < 0x20)
        return s[0] == '\t' || s[0] == '\n' || s[0] == '\r';
    bool control = s[0] == 0x7f || (s[0] == 0xc2 && s[1] < 0xa0);
    bool no_character = s[0] == 0xef && s[1] == 0xbf && s[2] > 0xbd; /* U+FFFE, U+FFFF */
    return !control && !no_character;
}

/* Returns the entity of a character that is markup, or white space that XML parsers change; or
 * NULL. */
static const char *entity_of(char c)
{
    switch (c) {
    case '\t':
        return "&#9;";
    case '\n':
        return "&#10;";
    case '\r':
        return "&#13;";
    default:
        return kiln_markup_entity(c);
    }
}

/* Writes a character of an attribute's value, or of content, in which line feeds and tabs stay as
 * they are. What XML cannot hold becomes U+FFFD: to leave it out could join two halves of a marker.
 * Returns the bytes of the character. */
static size_t write_character(FILE *out, const char *text, const void *is_attribute)
{
    const bool attribute = *(const bool *)is_attribute;
    const size_t length = kiln_text_character_length(text);
    const char *entity = !attribute && (*text == '\n' || *text == '\t') ? NULL : entity_of(*text);
    if (length == 0 || !is_allowed((const unsigned char *)text))
        fputs("\xef\xbf\xbd", out);
    else if (entity)
        fputs(entity, out);
    else
        fwrite(text, 1, length, out);
    return length > 0 ? length : 1;
}

/* Writes a text as an attribute's value or as content. Markers are broken, since CI servers act on
 * what an XML parser makes of the text. */
static void write_xml(FILE *out, const char *text, bool attribute)
{
    kiln_marker_write(out, text, write_character, &attribute);
}

static void write_attribute(FILE *out, const char *name, const char *value)
{
    fprintf(out, " %s=\"", name);
    write_xml(out, value, true);
    fputs("\"", out);
}

static void write_text(FILE *out, const char *text)
{
    write_xml(out, text, false);
}

/* ---- Properties --------------------------------------------------------------------------- */

static void write_property(FILE *out, const char *name, const char *value)
{
    if (!*value)
        return;
    fputs("      <property", out);
    write_attribute(out, "name", name);
    write_attribute(out, "value", value);
    fputs("/>\n", out);
}

/* Writes every text and whole number of the result as a property, except those that the report has
 * elsewhere. */
static void write_facts(FILE *out, const struct kiln_result *result)
{
    static const char *const reported_elsewhere[] = {"name", "message", "started"};
    for (const struct kiln_member *m = kiln_result_members; m->name; m++) {
        const void *value = (const char *)result + m->offset;
        bool is_reported = false;
        for (size_t i = 0; i < sizeof reported_elsewhere / sizeof *reported_elsewhere; i++)
            is_reported = is_reported || strcmp(m->name, reported_elsewhere[i]) == 0;
        char number[32];
        if (m->kind == KILN_MEMBER_UINT32 && result->frame_count) {
            snprintf(number, sizeof number, "%u", *(const uint32_t *)value);
            write_property(out, m->name, number);
        } else if (m->kind == KILN_MEMBER_TEXT && !is_reported) {
            write_property(out, m->name, *(const char *const *)value);
        }
    }
}

/* Writes the worst value of each metric with its limit: "0.0153 (at most 0.01)". */
static void write_metrics(FILE *out, const struct kiln_result *result)
{
    for (size_t i = 0; i < result->column_count; i++) {
        const struct kiln_compare_column *column = &result->columns[i];
        double worst = 0;
        if (!kiln_report_worst_value(result, i, &worst))
            return;
        char number[32], limit[32], value[128];
        kiln_report_text_number(number, worst);
        kiln_report_text_number(limit, column->limit);
        int length =
            snprintf(value, sizeof value, "%s%s%s", number, *column->unit ? " " : "", column->unit);
        if (column->limited && length > 0 && (size_t)length < sizeof value)
            snprintf(value + length, sizeof value - (size_t)length, " (at %s %s)",
                     column->higher_is_better ? "least" : "most", limit);
        write_property(out, column->name, value);
    }
}

static void write_hashes(FILE *out, const struct kiln_result *result)
{
    size_t written = 0;
    for (size_t i = 0; i < result->frame_count && written < KILN_REPORT_MAX_FRAMES;
         i++, written++) {
        const struct kiln_result_frame *frame = &result->frames[i];
        const struct {
            const char *key, *hash;
        } hashes[] = {{"state", frame->state},
                      {"state_expected", frame->state_expected},
                      {"pixels", frame->pixels},
                      {"pixels_expected", frame->pixels_expected}};
        for (size_t h = 0; h < sizeof hashes / sizeof *hashes; h++) {
            char name[64];
            snprintf(name, sizeof name, "frame_%u.%s", frame->number, hashes[h].key);
            write_property(out, name, hashes[h].hash);
        }
    }
}

static void write_properties(FILE *out, const struct kiln_result *result)
{
    char frames[32], score[32];
    snprintf(frames, sizeof frames, "%zu", result->frame_count);
    kiln_report_text_number(score, kiln_result_score(result));
    fputs("    <properties>\n", out);
    write_property(out, "status", kiln_test_status_name(result->status));
    write_facts(out, result);
    write_property(out, "frames", frames);
    write_property(out, "score", score);
    write_metrics(out, result);
    write_hashes(out, result);
    fputs("    </properties>\n", out);
}

/* ---- Problems and output -------------------------------------------------------------------- */

static const char *failure_type(const struct kiln_result *result)
{
    static const char *const types[KILN_JUDGED_BY_COUNT] = {
        [KILN_JUDGED_BY_NOTHING] = "picture-differs",
        [KILN_JUDGED_BY_STATE] = "simulation-changed",
        [KILN_JUDGED_BY_PIXELS] = "pixels-differ",
        [KILN_JUDGED_BY_METRICS] = "picture-differs",
    };
    if (result->status == KILN_TEST_NEW)
        return "golden-missing";
    for (size_t i = 0; i < result->frame_count; i++) {
        if (result->frames[i].status == KILN_TEST_FAIL)
            return types[result->frames[i].judged_by];
    }
    return "not-repeatable"; /* the test failed although no frame did */
}

static const char *error_type(enum kiln_code code)
{
    switch (code) {
    case KILN_USAGE:
        return "usage";
    case KILN_INVALID_INPUT:
        return "invalid-input";
    case KILN_NO_DEVICE:
        return "no-device";
    case KILN_DEVICE_FAILED:
        return "device-failed";
    case KILN_IO:
        return "input-output";
    case KILN_INTERRUPTED:
        return "interrupted";
    default:
        return "error";
    }
}

/* Calls `visit` for the first KILN_REPORT_MAX_FRAMES frames that did not pass, and returns how many
 * such frames are left out. */
static uint32_t visit_not_passed(FILE *out, const struct kiln_result *result,
                                 const struct kiln_result_place *place,
                                 void (*visit)(FILE *out, const struct kiln_result_frame *frame,
                                               const struct kiln_result_place *place))
{
    uint32_t visited = 0, left_out = 0;
    for (size_t i = 0; i < result->frame_count; i++) {
        if (result->frames[i].status == KILN_TEST_PASS)
            continue;
        if (visited == KILN_REPORT_MAX_FRAMES) {
            left_out++;
            continue;
        }
        visited++;
        visit(out, &result->frames[i], place);
    }
    return left_out;
}

static void write_cause(FILE *out, const struct kiln_result_frame *frame,
                        const struct kiln_result_place *place)
{
    (void)place;
    fprintf(out, "frame %u: %s: ", frame->number, kiln_test_status_name(frame->status));
    write_text(out, frame->message);
    fputs("\n", out);
}

/* Writes what is wrong with each frame, what changed in the scene, and the commands that help. */
static void write_causes(FILE *out, const struct kiln_result *result)
{
    write_text(out, result->message);
    fputs("\n", out);
    uint32_t left_out = visit_not_passed(out, result, NULL, write_cause);
    if (left_out)
        fprintf(out, "and %u frames more\n", left_out);
    for (size_t i = 0; i < result->change_count && i < KILN_REPORT_MAX_FRAMES; i++) {
        const struct kiln_result_change *change = &result->changes[i];
        fputs("scene: ", out);
        write_text(out, change->key);
        fputs(": ", out);
        write_text(out, *change->before ? change->before : "(nothing)");
        fputs(" -&gt; ", out);
        write_text(out, *change->after ? change->after : "(nothing)");
        if (*change->place) {
            fputs(" (", out);
            write_text(out, change->place);
            fputs(")", out);
        }
        fputs("\n", out);
    }
    if (*result->rerun) {
        fputs("to run it again: ", out);
        write_text(out, result->rerun);
        fputs("\n", out);
    }
    if (*result->approve && result->status != KILN_TEST_ERROR) {
        fputs("to accept it: ", out);
        write_text(out, result->approve);
        fputs("\n", out);
    }
}

static void write_problem(FILE *out, const struct kiln_result *result)
{
    bool error = result->status == KILN_TEST_ERROR;
    const char *element = error ? "error" : "failure";
    fprintf(out, "      <%s", element);
    write_attribute(out, "type", error ? error_type(result->code) : failure_type(result));
    write_attribute(out, "message", result->message);
    fputs(">", out);
    write_causes(out, result);
    fprintf(out, "</%s>\n", element);
}

/* Returns whether a CI server may upload a file of the result: a plain one below its folder, at a
 * path without signs that would end the attachment. */
static bool may_upload(const struct kiln_result_place *place, const char *file)
{
    struct kiln_result_file picture = kiln_result_picture(file);
    struct kiln_error ignored = {0};
    char path[KILN_PATH_SIZE];
    size_t size = 0;
    picture.limit = SIZE_MAX; /* a log may be long */
    if (!kiln_result_file_is_name(file) || strpbrk(place->results, "[]|\r\n"))
        return false;
    const int opened = kiln_result_file_open(place, &picture, path, &size, &ignored);
    if (opened >= 0)
        close(opened);
    return opened >= 0;
}

static void write_attachment(FILE *out, const struct kiln_result_place *place, const char *file)
{
    if (!*file || !place->results || !may_upload(place, file))
        return;
    fputs("[[ATTACHMENT|", out);
    write_text(out, place->results);
    fputs("/", out);
    write_text(out, place->name);
    fputs("/", out);
    write_text(out, file);
    fputs("]]\n", out);
}

static void write_frame_pictures(FILE *out, const struct kiln_result_frame *frame,
                                 const struct kiln_result_place *place)
{
    write_attachment(out, place, frame->picture);
    write_attachment(out, place, frame->reference);
    write_attachment(out, place, frame->error_map);
}

/* Writes the output of a case, if there are causes, notes or attachments. */
static void write_output(FILE *out, const struct kiln_result *result,
                         const struct kiln_result_place *place)
{
    bool quiet = result->status <= KILN_TEST_SKIP ||
                 (result->status == KILN_TEST_ERROR && !*result->log && !result->frame_count);
    if (quiet && result->note_count == 0)
        return;
    fputs("      <system-out>", out);
    if (result->status == KILN_TEST_WARN || result->status == KILN_TEST_CHANGE)
        write_causes(out, result);
    for (size_t i = 0; i < result->note_count; i++) {
        fputs("note: ", out);
        write_text(out, result->notes[i]);
        fputs("\n", out);
    }
    visit_not_passed(out, result, place, write_frame_pictures);
    if (result->status >= KILN_TEST_NEW)
        write_attachment(out, place, result->log);
    fputs("</system-out>\n", out);
}

/* ---- The document ------------------------------------------------------------------------- */

/* Writes the name of a case: "effects/fire" has the class "kiln.effects" and the name "fire". */
static void write_case_name(FILE *out, const char *name)
{
    const char *slash = strrchr(name, '/');
    write_attribute(out, "name", slash ? slash + 1 : name);
    char class[KILN_PATH_SIZE] = "";
    if (slash)
        snprintf(class, sizeof class, ".%.*s", (int)(slash - name), name);
    for (char *c = class; *c; c++) {
        if (*c == '/')
            *c = '.';
    }
    fputs(" classname=\"kiln", out);
    write_xml(out, class, true);
    fputs("\"", out);
}

static void write_case(FILE *out, const struct kiln_result *result,
                       const struct kiln_result_place *place, const char *seconds)
{
    fputs("    <testcase", out);
    write_case_name(out, result->name);
    write_attribute(out, "time", seconds);
    fputs(">\n", out);
    if (result->status == KILN_TEST_SKIP) {
        fputs("      <skipped>", out);
        write_text(out, result->message);
        fputs("</skipped>\n", out);
    }
    if (result->status >= KILN_TEST_NEW)
        write_problem(out, result);
    write_output(out, result, place);
    fputs("    </testcase>\n", out);
}

static void write_counts(FILE *out, const uint32_t counts[KILN_TEST_STATUS_COUNT], uint32_t tests,
                         const char *seconds)
{
    fprintf(out, " tests=\"%u\" failures=\"%u\" errors=\"%u\"", tests,
            counts[KILN_TEST_FAIL] + counts[KILN_TEST_NEW], counts[KILN_TEST_ERROR]);
    write_attribute(out, "time", seconds);
}

static void write_suite(FILE *out, const struct kiln_result *result,
                        const struct kiln_result_place *place)
{
    char seconds[32], started[32];
    kiln_report_text_seconds(seconds, result->total_s);
    /* The dialects that have a pattern for times allow no time zone. */
    snprintf(started, sizeof started, "%.*s", (int)strcspn(result->started, "Z"), result->started);
    uint32_t counts[KILN_TEST_STATUS_COUNT] = {0};
    counts[result->status]++;
    fputs("  <testsuite", out);
    write_attribute(out, "name", result->name);
    write_counts(out, counts, 1, seconds);
    fprintf(out, " skipped=\"%u\"", counts[KILN_TEST_SKIP]);
    if (*started)
        write_attribute(out, "timestamp", started);
    fputs(">\n", out);
    write_properties(out, result);
    write_case(out, result, place, seconds);
    fputs("  </testsuite>\n", out);
}

static bool write_junit(const struct kiln_results *results,
                        const struct kiln_results_output *output, FILE *out,
                        struct kiln_error *error)
{
    (void)output;
    (void)error;
    struct kiln_results_summary summary = kiln_results_summary(results);
    char seconds[32];
    kiln_report_text_seconds(seconds, summary.total_s);
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"kiln\"", out);
    write_counts(out, summary.counts, summary.tests, seconds);
    fputs(">\n", out);
    for (size_t i = 0; i < results->count; i++) {
        const struct kiln_result_place place = kiln_results_place(results, i);
        write_suite(out, results->tests[i], &place);
    }
    fputs("</testsuites>\n", out);
    return true;
}

const struct kiln_report_format kiln_report_junit = {
    .name = "junit",
    .help = "JUnit XML with the pictures as attachments, for Jenkins, GitLab and the like",
    .option = "--junit",
    .start = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"kiln\" ",
    .write = write_junit,
};
