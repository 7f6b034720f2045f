/* Checks that the test files of a suite name only scenes below the root of the suite. */
#ifndef KILN_SUITE_ROOT_H
#define KILN_SUITE_ROOT_H

#include "kiln_program.h"
#include "suite/suite.h"

/* Sets the test's problem (KILN_INVALID_INPUT) if its scene, with links resolved, lies outside the
 * root of the suite. The root is params->asset_root or, without one, the working directory. For a
 * test outside the working directory, the root is the folder among params->paths that contains it,
 * or else its own folder. */
void kiln_suite_check_root(const struct kiln_suite_params *params, struct kiln_test *test);

#endif
