/* SHA-256, by Nettle: names of contents, not protection. */
#ifndef KILN_BASE_HASH_H
#define KILN_BASE_HASH_H

#include <stdbool.h>
#include <stddef.h>

/* Writes the hash of size bytes in lower-case hex. */
void kiln_hash_sha256(const void *bytes, size_t size, char hex[65]);

/* The same of a file's contents, and of those of a descriptor from its start on, wherever it
 * stands; false, with errno, when they cannot be read. */
bool kiln_hash_sha256_file(const char *path, char hex[65]);
bool kiln_hash_sha256_descriptor(int file, char hex[65]);

#endif
