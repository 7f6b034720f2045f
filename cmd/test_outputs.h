/* Declares the options of reports that `kiln test` and `kiln test report` share, and the functions
 * that write the reports. */
#ifndef KILN_CMD_TEST_OUTPUTS_H
#define KILN_CMD_TEST_OUTPUTS_H

#include "options.h"

/* Rows of the option tables of both commands. */
#define OUTPUT_OPTIONS(report_fallback)                                                            \
    {.name = "report",                                                                             \
     .kind = OPTION_TEXT,                                                                          \
     .placeholder = "FILE",                                                                        \
     .help = "Where to write the page that shows the run. It is one HTML file.",                   \
     .fallback = report_fallback},                                                                 \
        {.name = "no-report", .kind = OPTION_FLAG, .help = "Write no page."},                      \
        {.name = "force",                                                                          \
         .kind = OPTION_FLAG,                                                                      \
         .help = "Replace also files that are not reports by kiln."},                              \
        {.name = "link",                                                                           \
         .kind = OPTION_FLAG,                                                                      \
         .help = "Let the page refer to the pictures in the results, instead of holding them."},   \
        {.name = "junit",                                                                          \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "FILE",                                                                    \
         .help = "Also write JUnit XML. For this and the next options, '-' is standard output."},  \
        {.name = "json",                                                                           \
         .value_is_optional = true,                                                                \
         .value_may_be_separate = true,                                                            \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "FILE",                                                                    \
         .files = "*.json",                                                                        \
         .help = "Also write all results as one JSON document. Without FILE, it goes to standard " \
                 "output."},                                                                       \
        {.name = "tap",                                                                            \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "FILE",                                                                    \
         .help = "Also write the Test Anything Protocol."},                                        \
        {.name = "github",                                                                         \
         .kind = OPTION_FLAG,                                                                      \
         .help = "Also print annotations for GitHub Actions on standard output."},                 \
    {                                                                                              \
        .name = "quiet", .letter = 'q', .kind = OPTION_FLAG,                                       \
        .help = "Print only failures and errors."                                                  \
    }

enum { MAX_OUTPUTS = 5 };

struct test_outputs {
    struct kiln_results_output files[MAX_OUTPUTS]; /* point into the arguments */
    size_t count;
    const char *page; /* where the HTML file goes; NULL without one, or when writing it failed */
    bool standard_output; /* a report takes it, so text for people goes to standard error */
};

/* Reads the options of the reports. page is where the HTML file goes without --report. Returns 0,
 * or the exit code after reporting what is wrong. */
int test_outputs_read(struct test_outputs *outputs, const struct arguments *arguments,
                      const char *command, const char *page);

/* Claims the files of all reports, before the run. Returns 0, or the exit code after reporting what
 * cannot be written. */
int test_outputs_claim(const struct test_outputs *outputs, struct kiln_claims *claims);

/* Writes all reports, or none if one would replace a file that the results of these folders are
 * made of. Returns the worse of `code` and that of its own failures, which it reports. */
enum kiln_code test_outputs_write(struct test_outputs *outputs, const struct kiln_results *results,
                                  const char *const *folders, size_t folder_count,
                                  enum kiln_code code);

#endif
