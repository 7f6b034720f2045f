/* Computes SHA-256 of bytes, files and descriptors, by Nettle, which uses the processor's
 * instructions for SHA-256 where there are any. */
#include "base/hash.h"

#include <errno.h>
#include <fcntl.h>
#include <nettle/sha2.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file_in.h"

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

bool kiln_hash_sha256_descriptor(int file, char hex[65])
{
    struct sha256_ctx sha;
    uint8_t block[1 << 16];
    ssize_t size;
    off_t at = 0;
    sha256_init(&sha);
    do {
        size = pread(file, block, sizeof block, at);
        if (size > 0) {
            sha256_update(&sha, (size_t)size, block);
            at += size;
        }
    } while (size > 0 || (size < 0 && errno == EINTR));
    finish(&sha, hex);
    return size == 0;
}

bool kiln_hash_sha256_file(const char *path, char hex[65])
{
    const int file = open(path, KILN_FILE_FLAGS);
    if (file < 0)
        return false;
    struct stat status;
    bool ok = fstat(file, &status) == 0;
    if (ok && !S_ISREG(status.st_mode)) { /* a pipe gives no bytes, and a device may never end */
        errno = S_ISDIR(status.st_mode) ? EISDIR : ESPIPE;
        ok = false;
    }
    ok = ok && kiln_hash_sha256_descriptor(file, hex);
    const int reason = errno;
    close(file);
    errno = reason;
    return ok;
}
