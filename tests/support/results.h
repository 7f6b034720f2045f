/* Writes the result files of an invented run of `kiln test`, in which golden tests have every
 * status. So tests of reports need no device and render nothing. */
#ifndef KILN_TESTS_RESULTS_H
#define KILN_TESTS_RESULTS_H

#include "kiln_program.h"

/* Writes the results of the run into a folder. good: true if all its tests pass, warn or are
 * skipped; false if there are also tests of every other status, and a test "lost" without a result,
 * as if its process had ended early. Returns false with an error on failure. */
bool test_write_run(const char *folder, bool good, struct kiln_error *error);

#endif
