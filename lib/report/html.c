/* Writes the report page, one file that needs no other unless pictures are linked. The list of
 * tests is plain HTML, which a browser shows before any script runs. The data of each test are
 * JSON, which the script reads when the test is opened. Pictures come last, those of the worst
 * tests first, so that the page works before they have loaded. A content security policy names the
 * page's own style and script by their hashes, so nothing else runs and nothing is fetched. */
#include <stdlib.h>
#include <string.h>

#include "base/embedded.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/text.h"
#include "report/gallery.h"
#include "report/markup.h"
#include "report/report.h"
#include "report/test_data.h"

struct page {
    const struct kiln_results *results;
    struct kiln_results_summary summary;
    size_t *order; /* indices of the tests, the worst first */
    struct kiln_gallery *gallery;
    struct kiln_text style, script;
    char hashes[2][65]; /* of style and script, in hex */
    bool link;
};

/* ---- Style and script --------------------------------------------------------------------- */

static bool load_code(struct page *page, struct kiln_error *error)
{
    static const char *const scripts[] = {"pictures.js", "viewer.js", "timeline.js",
                                          "details.js",  "list.js",   "report.js"};
    kiln_text_add(&page->style, "%s", kiln_embedded_find(kiln_embedded_page, "report.css"));
    kiln_text_add(&page->script, "\"use strict\";\n");
    for (size_t i = 0; i < sizeof scripts / sizeof *scripts; i++)
        kiln_text_add(&page->script, "%s", kiln_embedded_find(kiln_embedded_page, scripts[i]));
    if (page->style.failed || page->script.failed)
        return kiln_error_no_memory(error, "the report page");
    kiln_hash_sha256(page->style.data, page->style.length, page->hashes[0]);
    kiln_hash_sha256(page->script.data, page->script.length, page->hashes[1]);
    return true;
}

static unsigned digit_of(char c)
{
    return c <= '9' ? (unsigned)(c - '0') : (unsigned)(c - 'a' + 10);
}

static void write_hash(FILE *out, const char hex[65])
{
    unsigned char bytes[32];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (unsigned char)(digit_of(hex[2 * i]) << 4 | digit_of(hex[2 * i + 1]));
    fputs("'sha256-", out);
    kiln_markup_write_base64(out, bytes, sizeof bytes);
    fputc('\'', out);
}

static void write_policy(FILE *out, const void *user)
{
    const struct page *page = user;
    bool links = page->link || kiln_gallery_linked_for_size(page->gallery) > 0;
    fprintf(out, "default-src 'none'; base-uri 'none'; form-action 'none'; img-src data:%s",
            links ? " 'self' file:" : "");
    fputs("; style-src ", out);
    write_hash(out, page->hashes[0]);
    fputs("; script-src ", out);
    write_hash(out, page->hashes[1]);
}

static void write_style(FILE *out, const void *user)
{
    fputs(((const struct page *)user)->style.data, out);
}

static void write_script(FILE *out, const void *user)
{
    fputs(((const struct page *)user)->script.data, out);
}

/* ---- The summary -------------------------------------------------------------------------- */

static uint32_t count_not_passed(const struct kiln_results_summary *summary)
{
    return summary->counts[KILN_TEST_NEW] + summary->counts[KILN_TEST_FAIL] +
           summary->counts[KILN_TEST_ERROR];
}

static const char *plural(uint32_t count)
{
    return count == 1 ? "" : "s";
}

static void write_verdict(FILE *out, const void *user)
{
    const struct kiln_results_summary *summary = &((const struct page *)user)->summary;
    uint32_t not_passed = count_not_passed(summary), skipped = summary->counts[KILN_TEST_SKIP];
    uint32_t passed = summary->tests - not_passed - skipped;
    if (summary->tests == 0)
        fputs("No tests", out);
    else if (not_passed > 0)
        fprintf(out, "%u of %u test%s did not pass", not_passed, summary->tests,
                plural(summary->tests));
    else if (skipped == 0)
        fprintf(out, passed == 1 ? "The test passed" : "All %u tests passed", passed);
    else
        fprintf(out, "%u test%s passed, %u skipped", passed, plural(passed), skipped);
}

static void write_outcome(FILE *out, const void *user)
{
    const struct kiln_results_summary *summary = &((const struct page *)user)->summary;
    fputs(count_not_passed(summary) > 0 ? "red" : "green", out);
}

static void write_facts(FILE *out, const void *user)
{
    const struct page *page = user;
    const char *started = page->results->started;
    if (page->results->count > 0 && strlen(started) == strlen("2026-01-31T12:00:00Z")) {
        char text[32]; /* date and time with a blank between */
        snprintf(text, sizeof text, "%.10s %.8s UTC", started, started + strlen("2026-01-31T"));
        fputs("<time>", out);
        kiln_markup_write_text(out, text);
        fputs("</time>", out);
    }
    const bool any = page->results->count > 0 && *page->results->tests[0]->version;
    fprintf(out, "<span>%.1f s</span><span>kiln ", page->summary.total_s);
    kiln_markup_write_text(out, any ? page->results->tests[0]->version : KILN_VERSION);
    fputs("</span>", out);
    fputs("<span>", out);
    kiln_write_frames(out, &page->summary);
    fputs("</span>", out);
    uint32_t linked_for_size = kiln_gallery_linked_for_size(page->gallery);
    if (linked_for_size > 0)
        fprintf(out, "<span>%u picture%s linked: the page holds %d MiB of them</span>",
                linked_for_size, linked_for_size == 1 ? " is" : "s are", KILN_GALLERY_BYTES >> 20);
}

/* Returns the folder that all results lie in, or NULL when they lie in several. */
static const char *common_folder(const struct kiln_results *results)
{
    const char *folder = NULL;
    for (size_t i = 0; i < results->count; i++) {
        const char *own = kiln_results_place(results, i).results;
        if (!own || !*own || (folder && strcmp(own, folder) != 0))
            return NULL;
        folder = own;
    }
    return folder;
}

/* Writes one command that approves many pictures, with a button that copies it. */
static void write_approval(FILE *out, const void *user)
{
    const struct page *page = user;
    const uint32_t *counts = page->summary.counts;
    const uint32_t changed =
        counts[KILN_TEST_CHANGE] + counts[KILN_TEST_NEW] + counts[KILN_TEST_FAIL];
    const char *folder = changed > 1 ? common_folder(page->results) : NULL;
    struct kiln_text command = {0};
    if (!folder)
        return;
    kiln_text_add(&command, "kiln test approve --all");
    if (strcmp(folder, kiln_suite_defaults().results) != 0) {
        kiln_text_add(&command, *folder == '-' ? " --results ./" : " --results ");
        kiln_text_add_shell_word(&command, folder);
    }
    if (!command.failed) {
        fputs("<div class=\"command\" id=\"approve-all\"><div><span>To approve all pictures</span>"
              "<code>",
              out);
        kiln_markup_write_text(out, command.data);
        fputs("</code></div></div>\n", out);
    }
    kiln_text_free(&command);
}

/* Writes a button for each status that some test has, the worst first. */
static void write_counts(FILE *out, const void *user)
{
    const struct page *page = user;
    for (int status = KILN_TEST_STATUS_COUNT - 1; status >= 0; status--) {
        const char *name = kiln_test_status_name((enum kiln_test_status)status);
        uint32_t count = page->summary.counts[status];
        if (count > 0)
            fprintf(out,
                    "<button type=\"button\" class=\"count %s\" data-status=\"%s\" "
                    "aria-pressed=\"false\"><i class=\"mark\"></i><b>%u</b> %s</button>\n",
                    name, name, count, name);
    }
}

/* ---- The tests ---------------------------------------------------------------------------- */

static void write_score(FILE *out, const struct kiln_result *result)
{
    bool measured = false;
    for (size_t i = 0; i < result->frame_count; i++)
        measured = measured || result->frames[i].measured;
    if (!measured)
        return;
    double score = kiln_result_score(result);
    if (score > 9999)
        fputs("&gt;9999", out);
    else
        fprintf(out, score < 10 ? "%.2f" : "%.0f", score);
}

/* Writes a name as two parts: its folder, which is shown muted, and its last part. */
static void write_name(FILE *out, const char *name)
{
    const char *slash = strrchr(name, '/');
    char folder[KILN_PATH_SIZE];
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash + 1 - name) : 0, name);
    fputs("<span class=\"name\">", out);
    if (slash) {
        fputs("<span class=\"folder\">", out);
        kiln_markup_write_text(out, folder);
        fputs("</span>", out);
    }
    kiln_markup_write_text(out, slash ? slash + 1 : name);
    fputs("</span>", out);
}

/* Writes a data attribute, by which the script sorts. */
static void write_data(FILE *out, const char *name, double value)
{
    char text[32];
    kiln_text_from_double(text, value);
    fprintf(out, " data-%s=\"%s\"", name, text);
}

static void write_row(FILE *out, const struct page *page, size_t test)
{
    const struct kiln_result *result = page->results->tests[test];
    const char *status = kiln_test_status_name(result->status);
    fprintf(out, "<li class=\"%s\" data-test=\"%zu\" data-rank=\"%d\"", status, test,
            (int)result->status);
    write_data(out, "score", kiln_result_score(result));
    write_data(out, "time", result->total_s);
    fputs("><a href=\"#test=", out);
    kiln_markup_write_url(out, result->name);
    fprintf(out, "\"><i class=\"mark\"></i><span class=\"sr\">%s</span>", status);
    write_name(out, result->name);
    fputs("<span class=\"score\">", out);
    write_score(out, result);
    fputs("</span>", out);
    if (*result->message) {
        fputs("<span class=\"why\">", out);
        kiln_markup_write_text(out, result->message);
        fputs("</span>", out);
    }
    fputs("</a></li>\n", out);
}

static void write_rows(FILE *out, const void *user)
{
    const struct page *page = user;
    for (size_t i = 0; i < page->results->count; i++)
        write_row(out, page, page->order[i]);
}

static void write_tests(FILE *out, const void *user)
{
    const struct page *page = user;
    for (size_t i = 0; i < page->results->count; i++) {
        fprintf(out, "<script type=\"application/json\" id=\"t%zu\">", i);
        kiln_test_data_write(out, page->results, i, page->gallery);
        fputs("</script>\n", out);
    }
}

static void write_pictures(FILE *out, const void *user)
{
    kiln_gallery_write(((const struct page *)user)->gallery, out);
}

/* Orders tests: worse statuses first, then higher scores; equal ones stay in the order of their
 * names. */
static int compare_tests(const void *a, const void *b, void *user)
{
    const struct kiln_results *results = user;
    size_t i = *(const size_t *)a, j = *(const size_t *)b;
    const struct kiln_result *x = results->tests[i], *y = results->tests[j];
    if (x->status != y->status)
        return x->status > y->status ? -1 : 1;
    double x_score = kiln_result_score(x), y_score = kiln_result_score(y);
    if (x_score > y_score || x_score < y_score)
        return x_score > y_score ? -1 : 1;
    return (i > j) - (i < j);
}

static bool prepare(struct page *page, const struct kiln_results_output *output,
                    struct kiln_error *error)
{
    const struct kiln_results *results = page->results;
    page->summary = kiln_results_summary(results);
    page->order = kiln_arena_alloc(results->arena, results->count + 1, sizeof *page->order);
    if (!page->order)
        return kiln_error_no_memory(error, "the report page");
    for (size_t i = 0; i < results->count; i++)
        page->order[i] = i;
    qsort_r(page->order, results->count, sizeof *page->order, compare_tests,
            (struct kiln_results *)results);
    page->gallery = kiln_gallery_plan(results, page->order, output, error);
    return page->gallery && load_code(page, error);
}

static bool write_page(const struct kiln_results *results, const struct kiln_results_output *output,
                       FILE *out, struct kiln_error *error)
{
    struct page page = {.results = results, .link = output->link};
    const struct kiln_markup_field fields[] = {
        {"policy", write_policy, &page},     {"style", write_style, &page},
        {"script", write_script, &page},     {"verdict", write_verdict, &page},
        {"outcome", write_outcome, &page},   {"facts", write_facts, &page},
        {"approval", write_approval, &page}, {"counts", write_counts, &page},
        {"rows", write_rows, &page},         {"tests", write_tests, &page},
        {"pictures", write_pictures, &page}, {NULL, NULL, NULL},
    };
    bool ok = prepare(&page, output, error) &&
              kiln_markup_write_template(out, kiln_embedded_find(kiln_embedded_page, "report.html"),
                                         fields, error);
    kiln_text_free(&page.style);
    kiln_text_free(&page.script);
    return ok;
}

const struct kiln_report_format kiln_report_html = {
    .name = "html",
    .help = "a page for people: pictures side by side, metrics, commands; one file with all in it",
    .option = "--report",
    .start = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
             "<meta name=\"generator\" content=\"kiln\">\n",
    .write = write_page,
};
