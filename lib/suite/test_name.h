/* Checks and sanitizes names of tests. A test is named by the path of its file without the suffix.
 */
#ifndef KILN_SUITE_TEST_NAME_H
#define KILN_SUITE_TEST_NAME_H

#include <stdbool.h>

#include "base/arena.h"

enum { KILN_TEST_MAX_NAME = 200 }; /* bytes; with a device it must fit into a summary's 256 */

/* Returns whether a name is valid: it consists of letters of any script, digits, '.', '_', '-' and
 * '/', and no part between '/' starts with '.'. It must not start with '-', which would make it an
 * option in the commands that reports print. */
bool kiln_test_name_is_valid(const char *name);

/* Returns a valid name that resembles this one, with '_' for each byte that cannot be in a name;
 * NULL when memory is short. */
const char *kiln_test_name_sanitize(struct kiln_arena *arena, const char *name);

#endif
