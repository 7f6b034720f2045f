/* Copies public structs that begin with their own size between the library and a caller that may
 * have been built against another version. In later versions, such a struct grows only at its end.
 * The functions of the library that take or return such structs call these. */
#ifndef KILN_BASE_SIZED_H
#define KILN_BASE_SIZED_H

#include "kiln.h"

/* Copies into `own`, the library's struct, the members of the caller's struct `given` that both
 * versions have. `own` holds all defaults before; the other members keep them, and with `given`
 * NULL, all do. `what` names the struct in messages, such as "kiln_render_params". Returns false
 * with KILN_USAGE for a size that no struct has: one below that of `size` itself, or above 1 MiB.
 */
bool kiln_sized_take(void *own, const void *given, const char *what, struct kiln_error *error);

/* Checks the size of a struct of the caller as kiln_sized_take does. NULL is allowed. A function
 * that returns results calls it before it begins, and kiln_sized_give at its end. */
bool kiln_sized_check(const void *sized, const char *what, struct kiln_error *error);

/* Copies results from `own`, the library's struct, to `out`, the caller's: as many members as `out`
 * has room for. out->size is not changed and not checked. out may be NULL. */
void kiln_sized_give(void *out, const void *own);

#endif
