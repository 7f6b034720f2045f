/* Declares functions for the folder of results and the logs of tests, which the library does not
 * handle. */
#ifndef KILN_CMD_TEST_FILES_H
#define KILN_CMD_TEST_FILES_H

#include "kiln_program.h"

/* Returns "folder/name" in new memory; NULL when memory is short. */
char *join_path(const char *folder, const char *name);

/* Makes a folder and its parents, and locks it against other runs until the program ends. Returns
 * 0, or the exit code after reporting why not. */
int claim_folder(const char *path);

/* Removes a file; a missing file is no error. Returns false with errno. */
bool remove_file(const char *path);

/* Creates a log file, in place of an older one, and missing folders above it. Returns its
 * descriptor, which is open for appending, or below 0 with errno. */
int create_log(const char *path);

/* Writes the last line of a log that is not blank, without control characters and cut off where it
 * is long; "" if there is none. Returns line. */
enum { LOG_LINE_SIZE = 400 };
const char *last_log_line(const char *path, char line[LOG_LINE_SIZE]);

#endif
