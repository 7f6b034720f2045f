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

/* Return whether the name is that of a test file, such as "x.test.yaml", and that of a YAML file.
 */
bool kiln_test_file_is(const char *path);
bool kiln_test_file_is_yaml(const char *path);

/* Reads a test file, or takes the defaults for a scene; the file's name decides. Texts lie in the
 * arena. A fault of the file is no error here but becomes the test's problem; the test still has
 * the scene that the file names, if any. Returns false with KILN_DEVICE_FAILED when memory is
 * short. */
bool kiln_test_file_read(struct kiln_arena *arena, const char *path, struct kiln_test_file *file,
                         struct kiln_error *error);

/* Reads the text of a test file, which must end in a zero byte that size does not count. */
bool kiln_test_file_parse(struct kiln_arena *arena, const char *text, size_t size, const char *path,
                          struct kiln_test_file *file, struct kiln_error *error);

#endif
