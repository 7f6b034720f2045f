/* Computes SHA-256, by Nettle. The hashes name contents; they protect nothing. */
#ifndef KILN_BASE_HASH_H
#define KILN_BASE_HASH_H

#include <stdbool.h>
#include <stddef.h>

/* Writes the hash of size bytes in lower-case hex. */
void kiln_hash_sha256(const void *bytes, size_t size, char hex[65]);

/* Write the hash of a file's contents. A descriptor is read from the start of its file, wherever it
 * stands. False, with errno, when the contents cannot be read. */
bool kiln_hash_sha256_file(const char *path, char hex[65]);
bool kiln_hash_sha256_descriptor(int file, char hex[65]);

#endif
