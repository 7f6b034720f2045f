/* Copies structs that begin with their size (kiln.h) between the library and a caller that was
 * built against another version. */
#ifndef KILN_BASE_SIZED_H
#define KILN_BASE_SIZED_H

#include "kiln.h"

/* Fills `own`, which holds all defaults, with what was given as far as both know it; NULL: nothing.
 * `what` stands for the struct in messages: "kiln_render_params". KILN_USAGE for a size that no
 * version had. */
bool kiln_sized_take(void *own, const void *given, const char *what, struct kiln_error *error);

/* Checks that results can be copied to `out`: KILN_USAGE for a size that no version had. NULL is
 * allowed: the caller wants no results. */
bool kiln_sized_check(const void *out, const char *what, struct kiln_error *error);

/* Gives results as far as the caller's struct has room for them; its size stays. out may be NULL.
 */
void kiln_sized_give(void *out, const void *own);

#endif
