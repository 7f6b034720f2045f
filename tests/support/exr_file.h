/* Writes small EXR files for tests. */
#ifndef KILN_TESTS_EXR_FILE_H
#define KILN_TESTS_EXR_FILE_H

#include <stddef.h>
#include <stdint.h>

struct exr_bytes {
    unsigned char data[4096];
    size_t size;
};

struct exr_channel {
    const char *name;
    uint32_t type;     /* 0 uint, 1 half, 2 float */
    uint32_t bits;     /* of each sample */
    uint32_t sampling; /* 0: 1 */
};

/* Writes an uncompressed file of scan lines whose channels, which are in the order of their names,
 * are constant. data, display: the windows, left, top, right, bottom. */
void exr_file_write(struct exr_bytes *bytes, const struct exr_channel *channels, size_t count,
                    const int32_t data[4], const int32_t display[4]);

#endif
