/* Checks the jobs of a file before the first of them begins. */
#ifndef KILN_CMD_BATCH_CHECK_H
#define KILN_CMD_BATCH_CHECK_H

#include "kiln_program.h"

/* Checks that the frames and limits of all jobs can be parsed, and that no two jobs write the same
 * file. A job whose output is a folder writes a file with this suffix into it. Returns false with
 * an error that names the place in the file of jobs, or when memory is short. */
bool batch_check(const struct kiln_batch *batch, const char *suffix, struct kiln_error *error);

#endif
