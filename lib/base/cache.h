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

/* Fills `bytes` with what was written under this name, if it is so many bytes. False: there is no
 * such file, or it is not whole; then bytes may hold anything. */
bool kiln_cache_read_into(const char *folder, const char *name, void *bytes, size_t size);

/* Returns what was written under this name in memory that the caller frees. NULL where there is no
 * such file, or it is not whole, or memory is short. */
void *kiln_cache_read(const char *folder, const char *name, size_t size);

/* Makes missing folders, and removes what killed processes left. A name is 64 hexadecimal digits
 * and an ending, ".field": no other file makes room. */
void kiln_cache_write(const char *folder, const char *name, const void *bytes, size_t size);

#endif
