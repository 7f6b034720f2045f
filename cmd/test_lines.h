/* Prints what `kiln test` says to people. */
#ifndef KILN_CMD_TEST_LINES_H
#define KILN_CMD_TEST_LINES_H

#include "kiln_program.h"

struct test_lines {
    const struct kiln_suite *suite;
    FILE *out;
    bool quiet; /* only tests that went wrong */
    bool colour;
    int name_width;             /* of the column of names */
    const char *results;        /* the folder, as given */
    uint32_t written, to_write; /* pictures that updates wrote, or would write */
    const char *accept;         /* a test whose pictures might be accepted */
    uint32_t accept_count;      /* of all such tests */
};

/* Begins the lines of a suite's run; the suite outlives them. */
void test_lines_start(struct test_lines *lines, const struct kiln_suite *suite, FILE *out);

/* A line for a test that has ended, and one for each of its notes. */
void test_lines_test(struct test_lines *lines, const struct kiln_suite *suite, size_t index,
                     const struct kiln_test_summary *summary);

/* "5 tests in 1.234 s: 4 pass, 1 fail" */
void test_lines_counts(FILE *out, const struct kiln_results_summary *summary);

/* Prints what to look at and what to do next, and at last by what the frames were judged; page may
 * be NULL.
 */
void test_lines_end(const struct test_lines *lines, const struct kiln_results_summary *summary,
                    const char *page);

#endif
