/* Writes the results of a run with tests of every status, for tests of reports. */
#ifndef KILN_TESTS_RESULTS_H
#define KILN_TESTS_RESULTS_H

#include "kiln_program.h"

/* Writes results into a folder: with `good`, those of tests that did not fail, else those of all
 * tests, among them a test "lost" that has no result. */
bool test_write_run(const char *folder, bool good, struct kiln_error *error);

#endif
