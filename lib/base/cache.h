/* Keeps results that are slow to compute in files, from one run to the next. A damaged file is
 * ignored, and a file that cannot be written is no failure. */
#ifndef KILN_BASE_CACHE_H
#define KILN_BASE_CACHE_H

#include "kiln.h"

/* Limit of the size of all files of a cache. For a new file, those that were not read for the
 * longest time are removed. */
enum { KILN_CACHE_BYTES = 512 << 20 };

/* Finds the folder of the cache: $XDG_CACHE_HOME/kiln, or $HOME/.cache/kiln. False: neither
 * variable has an absolute path, or the path is too long. */
bool kiln_cache_folder(char folder[KILN_PATH_SIZE]);

/* Finds the folder of files that a driver trusts: $XDG_CACHE_HOME/kiln-programs, or
 * $HOME/.cache/kiln-programs, and makes it if it is missing. A forged file there could run code in
 * this process. So the folder lies outside of the one that a sandbox lets a job write, nobody but
 * this user may have rights to it, and nobody but this user and root may rename it. False: there is
 * no such folder, and none can be made. */
bool kiln_cache_private_folder(char folder[KILN_PATH_SIZE]);

/* Reads the file of a name into `bytes` if it has this size. False: there is no such file, or it is
 * damaged; then bytes may hold anything. */
bool kiln_cache_read_into(const char *folder, const char *name, void *bytes, size_t size);

/* Reads the file of a name into memory that the caller frees. NULL when there is no such file, it
 * is damaged, or memory is short. */
void *kiln_cache_read(const char *folder, const char *name, size_t size);

/* Reads the file of a name, whatever its size, up to `most` bytes; otherwise like kiln_cache_read.
 */
void *kiln_cache_read_any(const char *folder, const char *name, size_t most, size_t *size);

/* Writes a file. Makes missing folders, and removes temporary files of killed processes. A name is
 * 64 hexadecimal digits and an ending such as ".field"; only files with such names are removed to
 * make room. */
void kiln_cache_write(const char *folder, const char *name, const void *bytes, size_t size);

#endif
