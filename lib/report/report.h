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
    const char **folders;       /* of each test's result, with its pictures */
    size_t count;
    double total_s;
    const char *started;            /* of the earliest test */
    uint32_t missing_shard, shards; /* as in the summary */
};

struct kiln_report_format {
    const char *name; /* NULL ends the table */
    const char *help;
    const char *option; /* of `kiln test` */
    const char *start;  /* what every such file of kiln's begins with; NULL: it is no file */
    bool (*write)(const struct kiln_results *results, const struct kiln_results_output *output,
                  FILE *out, struct kiln_error *error);
};

extern const struct kiln_report_format kiln_report_json, kiln_report_junit, kiln_report_tap,
    kiln_report_github, kiln_report_html;

#endif
