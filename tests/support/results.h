/* A run with a test of each kind of outcome, for tests of reports. */
#ifndef KILN_TESTS_RESULTS_H
#define KILN_TESTS_RESULTS_H

#include "kiln_program.h"

/* Writes the results that are good, or all and "lost", which leaves none, to FOLDER. */
bool test_write_run(const char *folder, bool good, struct kiln_error *error);

#endif
