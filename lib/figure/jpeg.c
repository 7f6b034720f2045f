/* Encodes the pixels of a figure as JPEG of one fixed quality, for photographs of fire in
 * documents. */
#include "output/jpeg.h"

#include "figure/drawing.h"

/* The quantiser that --quality 84 to 90 gives to frames. */
enum { QUANTISER = 2 };

bool kiln_pixels_jpeg(const struct kiln_pixels *pixels, const struct kiln_imprint *imprint,
                      uint8_t **bytes, size_t *size, struct kiln_error *error)
{
    const struct kiln_jpeg jpeg = {.rgba = pixels->rgba,
                                   .width = pixels->width,
                                   .height = pixels->height,
                                   .quantiser = QUANTISER,
                                   .comment = imprint ? imprint->alt : NULL,
                                   .dpi = imprint ? imprint->dpi : 0};
    return kiln_jpeg_encode(&jpeg, bytes, size, error);
}
