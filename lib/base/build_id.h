/* Identifies the build of the program or library, for files that only the same code may read again.
 */
#ifndef KILN_BASE_BUILD_ID_H
#define KILN_BASE_BUILD_ID_H

#include <stdbool.h>

enum { KILN_BUILD_ID_SIZE = 65 };

/* Writes, in hex, the identifier that the linker made of the contents of the program, or of the
 * shared library, that kiln's code lies in. False: it has none. */
bool kiln_build_id(char hex[KILN_BUILD_ID_SIZE]);

#endif
