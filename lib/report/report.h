/* Declares the formats of reports of a run. Each format is a file of its own and a row of the table
 * in report.c. */
#ifndef KILN_REPORT_REPORT_H
#define KILN_REPORT_REPORT_H

#include "kiln_program.h"
#include "suite/result.h"

/* The run or runs that are reported. */
struct kiln_results {
    struct kiln_arena *arena;
    struct kiln_result **tests; /* ordered by name */
    const char **folders;       /* folder of each test's result and pictures: RESULTS/NAME */
    size_t count;
    double total_s;
    const char *started;            /* when the earliest test started */
    uint32_t missing_shard, shards; /* as in kiln_results_summary */
};

/* Returns where the result of a test is, for the files that it names. `results` is "" for a test
 * whose results are not there. NULL in it when memory is short. */
struct kiln_result_place kiln_results_place(const struct kiln_results *results, size_t test);

struct kiln_report_format {
    const char *name; /* NULL ends the table */
    const char *help;
    const char *option; /* the option of `kiln test` for this format */
    const char *start;  /* the first bytes of every file of this format; NULL: not a file */
    bool (*write)(const struct kiln_results *results, const struct kiln_results_output *output,
                  FILE *out, struct kiln_error *error);
};

extern const struct kiln_report_format kiln_report_json, kiln_report_junit, kiln_report_tap,
    kiln_report_github, kiln_report_html;

#endif
