/* Prints the results of `kiln test` for people. */
#ifndef KILN_CMD_TEST_LINES_H
#define KILN_CMD_TEST_LINES_H

#include "kiln_program.h"
#include "options.h"

struct test_lines {
    const struct kiln_suite *suite;
    FILE *out;
    bool quiet; /* print only tests that went wrong */
    bool colour;
    int name_width;                    /* width of the column of names, in characters */
    const char *results;               /* the folder of results, as given */
    uint32_t written, to_write;        /* pictures that updates wrote, or would write */
    const struct arguments *arguments; /* of the command line */
    const char *approvable;            /* the last test whose pictures might be accepted */
    uint32_t approvable_count;         /* number of such tests */
};

/* Prepares to print the lines of a suite's run; the suite must outlive them. */
void test_lines_start(struct test_lines *lines, const struct kiln_suite *suite, FILE *out);

/* Prints a line for a test that has ended, and a line for each of its notes. */
void test_lines_test(struct test_lines *lines, const struct kiln_suite *suite, size_t index,
                     const struct kiln_test_summary *summary);

/* Prints the line "5 tests in 1.234 s: 4 pass, 1 fail". */
void test_lines_counts(FILE *out, const struct kiln_results_summary *summary);

/* Prints the path of the report, what to do next, and by what the frames were judged. page may be
 * NULL. */
void test_lines_end(const struct test_lines *lines, const struct kiln_results_summary *summary,
                    const char *page);

#endif
