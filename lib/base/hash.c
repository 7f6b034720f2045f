/* Nettle's SHA-256 takes the processor's own instructions where it has them. FFmpeg loads the
 * library anyway, for its protocols. */
#include "base/hash.h"

#include <nettle/sha2.h>
#include <stdint.h>
#include <stdio.h>

static void finish(struct sha256_ctx *sha, char hex[65])
{
    uint8_t digest[SHA256_DIGEST_SIZE];
    sha256_digest(sha, sizeof digest, digest);
    for (size_t i = 0; i < sizeof digest; i++)
        snprintf(hex + 2 * i, 3, "%02x", digest[i]);
}

void kiln_hash_sha256(const void *bytes, size_t size, char hex[65])
{
    struct sha256_ctx sha;
    sha256_init(&sha);
    sha256_update(&sha, size, bytes);
    finish(&sha, hex);
}

bool kiln_hash_sha256_file(const char *path, char hex[65])
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return false;
    struct sha256_ctx sha;
    uint8_t block[1 << 16];
    size_t size;
    sha256_init(&sha);
    while ((size = fread(block, 1, sizeof block, file)) > 0)
        sha256_update(&sha, size, block);
    const bool ok = !ferror(file);
    finish(&sha, hex);
    fclose(file);
    return ok;
}
