/* Finds goldens that no test uses. */
#ifndef KILN_SUITE_UNUSED_H
#define KILN_SUITE_UNUSED_H

#include "kiln_program.h"
#include "suite/suite.h"

/* Lists the folders below `golden` that hold what was accepted of a test which is not among the
 * suite's. The suite must have all tests that were found in the folders that were searched. Folders
 * that cannot be read are passed over. False when memory is short. */
bool kiln_unused_find(struct kiln_suite *suite, const char *golden);

#endif
