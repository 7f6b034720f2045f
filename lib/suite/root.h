/* Checks which scenes the test files of a suite may name. */
#ifndef KILN_SUITE_ROOT_H
#define KILN_SUITE_ROOT_H

#include "kiln_program.h"
#include "suite/suite.h"

/* Gives a test whose scene lies outside the root of the suite, by where the paths lead, a problem
 * that says so (KILN_INVALID_INPUT). The root is params->asset_root or, without one, the working
 * directory; for a test outside that, the folder among params->paths that it was found in, or its
 * own. */
void kiln_suite_check_root(const struct kiln_suite_params *params, struct kiln_test *test);

#endif
