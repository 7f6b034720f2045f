/* Keeps the folder of a run's results. In this folder, kiln removes and replaces only files that it
 * wrote itself and that have not changed since. The file .kiln-results lists them with their
 * SHA-256, in the format of sha256sum. */
#ifndef KILN_SUITE_RESULTS_FOLDER_H
#define KILN_SUITE_RESULTS_FOLDER_H

#include "kiln_program.h"
#include "suite/suite.h"

#define KILN_RESULTS_LIST ".kiln-results"

/* Adds the files of a run's tests and run.json to the list after the run. Entries of other runs
 * stay. KILN_IO, KILN_DEVICE_FAILED when memory is short. */
bool kiln_results_folder_end(const struct kiln_suite *suite, struct kiln_error *error);

#endif
