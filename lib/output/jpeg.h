/* Encodes JPEG in memory, for frames and for figures. */
#ifndef KILN_OUTPUT_JPEG_H
#define KILN_OUTPUT_JPEG_H

#include "base/error.h"

/* A picture, and the settings of its file. */
struct kiln_jpeg {
    const uint8_t *rgba; /* 8 bits, sRGB, rows from the top; alpha is ignored */
    uint32_t width, height;
    uint32_t quantiser;  /* quantiser on FFmpeg's scale, 1 (best) to 31 */
    const char *comment; /* comment of the file, UTF-8, cut at 65533 bytes; NULL: none */
    uint32_t dpi;        /* pixels per inch, up to 65535; 0: the file does not say */
};

/* Encodes the picture with full chroma. The bytes are the same on every machine. Any thread may
 * call. The caller frees the bytes. KILN_IO where FFmpeg or its encoder is missing,
 * KILN_DEVICE_FAILED when memory is short. */
bool kiln_jpeg_encode(const struct kiln_jpeg *jpeg, uint8_t **bytes, size_t *size,
                      struct kiln_error *error);

#endif
