/* Declares the files that a run of tests handles beside those of the library. */
#ifndef KILN_CMD_TEST_FILES_H
#define KILN_CMD_TEST_FILES_H

#include "kiln_program.h"

/* "folder/name" in new memory; NULL when memory is short. */
char *join_path(const char *folder, const char *name);

/* Makes a folder and those above it, and keeps other runs out of it until the program ends.
 * Returns 0, or the exit code after reporting why not. */
int claim_folder(const char *path);

/* Removes a file that need not be there; false with errno. */
bool remove_file(const char *path);

/* Creates a log file, in place of an older one, and missing folders above it. Returns its
 * descriptor, to which all writing appends, or below 0 with errno. */
int create_log(const char *path);

/* The last line of a log that has something on it, printable and cut off where it is long; "" when
 * there is none. */
enum { LOG_LINE_SIZE = 400 };
const char *last_log_line(const char *path, char line[LOG_LINE_SIZE]);

#endif
