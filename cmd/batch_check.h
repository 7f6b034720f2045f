/* Checks the jobs of a file before the first of them begins. */
#ifndef KILN_CMD_BATCH_CHECK_H
#define KILN_CMD_BATCH_CHECK_H

#include "kiln_program.h"

/* Whether the frames and limits of all jobs can be read, and no two jobs would write one file. A
 * job whose output is a folder writes a file of that suffix in it. False with the place in the file
 * of jobs, or when memory is short. */
bool batch_check(const struct kiln_batch *batch, const char *suffix, struct kiln_error *error);

#endif
