/* Declares the functions that compute SHA-256 by Nettle. Scenes, assets, goldens, figures, caches
 * and outputs use the hash to tell whether contents are the same; it is no signature.
 *
 * Goldens, manifests and caches on disk hold these hashes, so the algorithm and the spelling in
 * lower-case hex must not change. The hash of a file is the one that sha256sum prints. */
#ifndef KILN_BASE_HASH_H
#define KILN_BASE_HASH_H

#include <stdbool.h>
#include <stddef.h>

/* Writes the hash of size bytes in lower-case hex, with a terminating zero. */
void kiln_hash_sha256(const void *bytes, size_t size, char hex[65]);

/* Write the hash of a file's contents. A descriptor is read from the start of its file, and its
 * offset stays as it is, so a pipe cannot be read. kiln_hash_sha256_file reads regular files alone,
 * and never waits for a pipe. Return false, with errno, when the contents cannot be read. */
bool kiln_hash_sha256_file(const char *path, char hex[65]);
bool kiln_hash_sha256_descriptor(int file, char hex[65]);

#endif
