/* Reads a test file, or a scene that is a test by itself. */
#ifndef KILN_SUITE_TEST_FILE_H
#define KILN_SUITE_TEST_FILE_H

#include "suite/suite.h"

enum { KILN_TEST_MAX_DEVICES = 16 };

struct kiln_test_file {
    struct kiln_test test; /* without names, folders and a device */
    const char **devices;
    size_t device_count;
};

/* Whether a file of this name is a test file, "x.test.yaml", and whether it is a YAML file at all.
 */
bool kiln_test_file_is(const char *path);
bool kiln_test_file_is_yaml(const char *path);

/* Reads the file, by its name a test file or a scene; what it says lies in the arena. A file that
 * is wrong is no error but the problem of the test, which has a scene all the same where the file
 * names one. False with KILN_DEVICE_FAILED when memory is short. */
bool kiln_test_file_read(struct kiln_arena *arena, const char *path, struct kiln_test_file *file,
                         struct kiln_error *error);

/* Reads the text of a test file, which must end in a zero byte that size does not count. */
bool kiln_test_file_parse(struct kiln_arena *arena, const char *text, size_t size, const char *path,
                          struct kiln_test_file *file, struct kiln_error *error);

#endif
