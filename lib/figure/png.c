/* PNG in memory: made for size, unlike frames, since figures are read often and made once. */
#include <png.h>
#include <stdlib.h>

#include "base/error.h"
#include "figure/drawing.h"

bool kiln_pixels_png(const struct kiln_pixels *pixels, uint8_t **bytes, size_t *size,
                     struct kiln_error *error)
{
    size_t count = (size_t)pixels->width * pixels->height;
    uint8_t *rgb = malloc(count * 3);
    for (size_t i = 0; rgb && i < count; i++) {
        rgb[3 * i] = pixels->rgba[4 * i];
        rgb[3 * i + 1] = pixels->rgba[4 * i + 1];
        rgb[3 * i + 2] = pixels->rgba[4 * i + 2];
    }
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = pixels->width,
                       .height = pixels->height,
                       .format = PNG_FORMAT_RGB};
    *size = PNG_IMAGE_PNG_SIZE_MAX(image);
    *bytes = rgb ? malloc(*size) : NULL;
    bool ok = *bytes && png_image_write_to_memory(&image, *bytes, size, 0, rgb, 0, NULL);
    png_image_free(&image);
    free(rgb);
    if (ok)
        return true;
    free(*bytes);
    *bytes = NULL;
    return kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for a PNG of %u x %u pixels",
                          pixels->width, pixels->height);
}
