/* Checks and mends names of tests. A name is that of a file without its end, and becomes a folder.
 */
#ifndef KILN_SUITE_TEST_NAME_H
#define KILN_SUITE_TEST_NAME_H

#include <stdbool.h>

#include "base/arena.h"

enum { KILN_TEST_MAX_NAME = 200 }; /* bytes; with a device it goes into a summary's 256 */

/* Whether a name is good: made of letters (of any script), digits, '.', '_' and '-' in folders,
 * none of which starts with a '.'. It must not look like an option in the commands that reports
 * give. */
bool kiln_test_name_is_good(const char *name);

/* Returns a good name that is like this one, with '_' for each byte that cannot be in a name; NULL
 * when memory is short. */
const char *kiln_test_name_mended(struct kiln_arena *arena, const char *name);

#endif
