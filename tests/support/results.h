/* Writes the files of a test run in which tests have every status. So tests of reports need no
 * device and render nothing. */
#ifndef KILN_TESTS_RESULTS_H
#define KILN_TESTS_RESULTS_H

#include "kiln_program.h"

/* Writes the results of a run into a folder. With `good` set, all its tests pass, warn or are
 * skipped. Otherwise there are also tests of every other status, and a test "lost" without a
 * result, as if its process had ended early. */
bool test_write_run(const char *folder, bool good, struct kiln_error *error);

#endif
