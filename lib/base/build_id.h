/* Identifies the build of kiln. Files whose content depends on the code have the build in their
 * names, so that another build does not use them: the cache of flipbooks (asset/atlas). */
#ifndef KILN_BASE_BUILD_ID_H
#define KILN_BASE_BUILD_ID_H

#include <stdbool.h>

enum { KILN_BUILD_ID_SIZE = 65 }; /* of the text with its zero byte: at most 32 bytes in hex */

/* Writes, in hex, the build ID of the program or shared library that contains kiln's code. The
 * linker computes it from that file's contents (ELF note NT_GNU_BUILD_ID). Returns false where the
 * file has no such ID. */
bool kiln_build_id(char hex[KILN_BUILD_ID_SIZE]);

#endif
