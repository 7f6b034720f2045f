/* libavutil is linked for video anyway and has a tested SHA-256. */
#include "base/hash.h"

#include <libavutil/mem.h>
#include <libavutil/sha.h>
#include <stdint.h>
#include <stdio.h>

bool kiln_hash_sha256(const void *bytes, size_t size, char hex[65])
{
    struct AVSHA *sha = av_sha_alloc();
    if (!sha)
        return false;
    uint8_t digest[32];
    av_sha_init(sha, 256);
    av_sha_update(sha, bytes, size);
    av_sha_final(sha, digest);
    av_free(sha);
    for (size_t i = 0; i < sizeof digest; i++)
        snprintf(hex + 2 * i, 3, "%02x", digest[i]);
    return true;
}
