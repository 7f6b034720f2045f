/* Sums up results, and starts the result of a test. */
#ifndef KILN_SUITE_SUMMARY_H
#define KILN_SUITE_SUMMARY_H

#include "kiln_program.h"
#include "suite/suite.h"

/* Returns a result of the test with all that is known before a run, such as the time, and "" or 0
 * for the rest. Its texts point into the suite. Returns NULL when memory is short. */
struct kiln_result *kiln_result_start(struct kiln_arena *arena, const struct kiln_test *test);

void kiln_summary_take(struct kiln_test_summary *summary, const struct kiln_result *result);

#endif
