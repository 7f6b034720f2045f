/* Finds goldens that no test uses. */
#ifndef KILN_SUITE_UNUSED_H
#define KILN_SUITE_UNUSED_H

#include "kiln_program.h"
#include "suite/suite.h"

/* Fills suite->unused with the folders below `golden` that have an expect.yaml but belong to no
 * test of the suite. The suite must have all tests that were found in the searched folders. Folders
 * that cannot be read are skipped. Returns false when memory is short. */
bool kiln_unused_find(struct kiln_suite *suite, const char *golden);

#endif
