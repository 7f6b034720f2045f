/* The JPEG of a figure, for photographs of fire in documents: of one quality. */
#include "output/jpeg.h"

#include "figure/drawing.h"

/* FFmpeg's scale of quantisers, from 1; about what other programs call quality 92. */
enum { QUANTISER = 2 };

bool kiln_pixels_jpeg(const struct kiln_pixels *pixels, uint8_t **bytes, size_t *size,
                      struct kiln_error *error)
{
    const struct kiln_jpeg jpeg = {pixels->rgba, pixels->width, pixels->height, QUANTISER, NULL};
    return kiln_jpeg_encode(&jpeg, bytes, size, error);
}
