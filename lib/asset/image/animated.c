/* This file walks through the blocks of WebP, PNG and GIF files up to the place that says whether
 * they are animated. The files are a stranger's: whatever does not fit ends the walk. */
#include "asset/image/animated.h"

#include <string.h>
#include <unistd.h>

enum { MOST_BLOCKS = 1 << 20 }; /* of a GIF; beyond it, the file counts as a still picture */

static bool read_at(int file, uint64_t at, uint8_t *bytes, size_t size)
{
    return pread(file, bytes, size, (off_t)at) == (ssize_t)size;
}

bool kiln_file_is_webp(int file)
{
    uint8_t head[12];
    return read_at(file, 0, head, sizeof head) && memcmp(head, "RIFF", 4) == 0 &&
           memcmp(head + 8, "WEBP", 4) == 0;
}

bool kiln_file_is_gif(int file)
{
    uint8_t head[4];
    return read_at(file, 0, head, sizeof head) && memcmp(head, "GIF8", 4) == 0;
}

bool kiln_file_is_exr(int file)
{
    uint8_t head[4];
    return read_at(file, 0, head, sizeof head) && memcmp(head, "v/1\x01", 4) == 0;
}

bool kiln_file_is_tiff(int file)
{
    uint8_t head[4];
    return read_at(file, 0, head, sizeof head) &&
           (memcmp(head, "II*\0", 4) == 0 || memcmp(head, "MM\0*", 4) == 0 ||
            memcmp(head, "II+\0", 4) == 0 || memcmp(head, "MM\0+", 4) == 0);
}

static bool is_animated_webp(int file)
{
    uint8_t chunk[9];
    return read_at(file, 12, chunk, sizeof chunk) && memcmp(chunk, "VP8X", 4) == 0 &&
           (chunk[8] & 2) != 0;
}

/* In a PNG, the chunk acTL comes before the pixels. */
static bool is_animated_png(int file)
{
    uint8_t head[8];
    uint64_t at = 8;
    for (int i = 0; i < MOST_BLOCKS && read_at(file, at, head, sizeof head); i++) {
        if (memcmp(head + 4, "acTL", 4) == 0)
            return true;
        if (memcmp(head + 4, "IDAT", 4) == 0)
            return false;
        at += 12 + ((uint64_t)head[0] << 24 | (uint64_t)head[1] << 16 | (uint64_t)head[2] << 8 |
                    head[3]);
    }
    return false;
}

/* Returns the bytes of a table of colours, by the flags that announce it. */
static uint64_t palette_bytes(uint8_t flags)
{
    return flags & 0x80 ? 3ull << ((flags & 7) + 1) : 0;
}

/* Moves behind a row of sub-blocks, each with its size before it. The last one has the size 0. */
static bool skip_blocks(int file, uint64_t *at, int *left)
{
    uint8_t size = 1;
    while (size > 0) {
        if ((*left)-- <= 0 || !read_at(file, *at, &size, 1))
            return false;
        *at += 1u + size;
    }
    return true;
}

static bool is_animated_gif(int file)
{
    enum { EXTENSION = 0x21, IMAGE = 0x2c };
    uint8_t head[13], block[10];
    int images = 0, left = MOST_BLOCKS;
    if (!read_at(file, 0, head, sizeof head))
        return false;
    uint64_t at = 13 + palette_bytes(head[10]);
    while (images < 2 && left > 0 && read_at(file, at, block, 1)) {
        if (block[0] == IMAGE && read_at(file, at, block, sizeof block)) {
            images++;
            at += 10 + palette_bytes(block[9]) + 1; /* 1: the size of the codes */
        } else if (block[0] == EXTENSION) {
            at += 2;
        } else {
            break;
        }
        if (!skip_blocks(file, &at, &left))
            break;
    }
    return images >= 2;
}

bool kiln_file_is_animated(int file)
{
    uint8_t head[8];
    if (!read_at(file, 0, head, sizeof head))
        return false;
    if (memcmp(head, "\x89PNG\r\n\x1a\n", 8) == 0)
        return is_animated_png(file);
    if (memcmp(head, "GIF8", 4) == 0)
        return is_animated_gif(file);
    return kiln_file_is_webp(file) && is_animated_webp(file);
}
