/* Opens the files in a folder of results. Such folders travel between machines, so whoever made one
 * may be a stranger: names are checked, and what is opened is a plain file below the folder, which
 * is opened once and never waited for. */
#ifndef KILN_SUITE_RESULT_FILE_H
#define KILN_SUITE_RESULT_FILE_H

#include "kiln.h"

/* The struct names the result of a test, RESULTS/NAME. `results` is the folder that the user names.
 */
struct kiln_result_place {
    const char *results;
    const char *name;
};

/* Returns whether a text may be the full name of a test, NAME or NAME@DEVICE. */
bool kiln_result_name_is_valid(const char *name);

/* Returns whether a text may be the name of a file in the folder of a result: letters, digits, '_',
 * '-' and '.', which is not the first. kiln writes no others. */
bool kiln_result_file_is_name(const char *name);

/* Opens a plain file of a result for reading; path receives its path, for messages. Returns its
 * descriptor, which the caller closes, and its size. Returns -1 with KILN_INVALID_INPUT when it is
 * a link, no plain file or larger than `limit`, or when a link leads out of the folder; with
 * KILN_IO when it cannot be opened. `what` and `allowed` are as in base/file_in.h. */
struct kiln_result_file {
    const char *name;
    const char *what, *allowed;
    size_t limit;
};
int kiln_result_file_open(const struct kiln_result_place *place,
                          const struct kiln_result_file *file, char path[KILN_PATH_SIZE],
                          size_t *size, struct kiln_error *error);

/* Returns the bytes of a picture of a result, which the caller frees, or NULL with an error. */
unsigned char *kiln_result_picture_read(const struct kiln_result_place *place, const char *name,
                                        size_t *size, struct kiln_error *error);

/* Describes a picture of a result for kiln_result_file_open. */
struct kiln_result_file kiln_result_picture(const char *name);

/* Checks that the folder of a result is not reached by a link, if it is there: a run would remove
 * and write files wherever the link leads. KILN_USAGE. */
bool kiln_result_folder_check(const struct kiln_result_place *place, struct kiln_error *error);

#endif
