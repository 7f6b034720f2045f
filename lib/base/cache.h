/* Files that can be made again, kept from one run to the next. A file that is not as it was written
 * counts for nothing, and what cannot be written is no failure. */
#ifndef KILN_BASE_CACHE_H
#define KILN_BASE_CACHE_H

#include "kiln.h"

/* What all files of a cache have together, at most: the ones that nobody has read for longest make
 * room for a new one. */
enum { KILN_CACHE_BYTES = 512 << 20 };

/* Where they are: $XDG_CACHE_HOME/kiln, or $HOME/.cache/kiln. False: nowhere. */
bool kiln_cache_folder(char folder[KILN_PATH_SIZE]);

/* The bytes that were written under this name, if they are so many; the caller frees them. NULL:
 * there is no such file, it is not whole, or memory is short. */
void *kiln_cache_read(const char *folder, const char *name, size_t size);

/* Makes missing folders, and removes what killed processes left. The name does not begin with a
 * point. */
void kiln_cache_write(const char *folder, const char *name, const void *bytes, size_t size);

#endif
