/* libavutil is linked for video anyway and has a tested SHA-256. */
#include "base/hash.h"

#include <libavutil/mem.h>
#include <libavutil/sha.h>
#include <stdint.h>
#include <stdio.h>

static void finish(struct AVSHA *sha, char hex[65])
{
    uint8_t digest[32];
    av_sha_final(sha, digest);
    for (size_t i = 0; i < sizeof digest; i++)
        snprintf(hex + 2 * i, 3, "%02x", digest[i]);
}

bool kiln_hash_sha256(const void *bytes, size_t size, char hex[65])
{
    struct AVSHA *sha = av_sha_alloc();
    if (!sha)
        return false;
    av_sha_init(sha, 256);
    av_sha_update(sha, bytes, size);
    finish(sha, hex);
    av_free(sha);
    return true;
}

bool kiln_hash_sha256_file(const char *path, char hex[65])
{
    FILE *file = fopen(path, "rb");
    struct AVSHA *sha = file ? av_sha_alloc() : NULL;
    bool ok = sha != NULL;
    if (ok) {
        uint8_t block[16384];
        size_t size;
        av_sha_init(sha, 256);
        while ((size = fread(block, 1, sizeof block, file)) > 0)
            av_sha_update(sha, block, size);
        ok = !ferror(file);
        finish(sha, hex);
    }
    av_free(sha);
    if (file)
        fclose(file);
    return ok;
}
