/* Sums up results, and makes the result that a test has before anything is known. */
#ifndef KILN_SUITE_SUMMARY_H
#define KILN_SUITE_SUMMARY_H

#include "kiln_program.h"
#include "suite/suite.h"

/* Makes a result of the test with all that is known before a run, the time included, and "" or 0
 * for the rest; NULL when memory is short. It refers to the suite's texts. */
struct kiln_result *kiln_result_start(struct kiln_arena *arena, const struct kiln_test *test);

void kiln_summary_take(struct kiln_test_summary *summary, const struct kiln_result *result);

#endif
