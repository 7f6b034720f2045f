/* Joins and compares paths, and reads text files whole: only regular files, of limited size. */
#ifndef KILN_BASE_FILE_H
#define KILN_BASE_FILE_H

#include "kiln.h"

/* Writes "FOLDER/NAME"; KILN_IO when it is too long. */
bool kiln_path_join(char path[KILN_PATH_SIZE], const char *folder, const char *name,
                    struct kiln_error *error);

/* The part of a path below a folder, NULL when it is not below. Both are as realpath gives them. */
const char *kiln_path_below(const char *path, const char *folder);

/* The contents of a regular file with a zero byte after them, which *size does not count; the
 * caller frees them. what stands for it in messages: "a scene file". NULL with KILN_INVALID_INPUT
 * when it cannot be opened, is no regular file or has more bytes than limit, KILN_IO when reading
 * fails, KILN_DEVICE_FAILED when memory is short. */
char *kiln_text_file_read(const char *path, const char *what, size_t limit, size_t *size,
                          struct kiln_error *error);

#endif
