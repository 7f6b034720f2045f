/* Checks the result of a decoder, for the fuzz targets that decode pictures and videos. */
#ifndef KILN_FUZZ_IMAGE_CHECK_H
#define KILN_FUZZ_IMAGE_CHECK_H

#include "asset/image/image.h"
#include "fuzz.h"

/* Requires that a decoder returned either an image within the size limits, or NULL and an error
 * with a message. Otherwise crashes, as a fuzz target does to report a fault. Destroys the image.
 * Returns whether there was an image. */
static inline bool check_image(struct kiln_asset_image *image, const struct kiln_error *error)
{
    if (!image) {
        require(error->code != KILN_OK && *error->message, "an error without a message");
        return false;
    }
    require(image->width >= 1 && image->width <= KILN_MAX_IMAGE_EDGE && image->height >= 1 &&
                image->height <= KILN_MAX_IMAGE_EDGE &&
                image->width * image->height <= KILN_MAX_IMAGE_PIXELS,
            "an image beyond the limits");
    require(image->channels >= 1 && image->channels <= 4, "an image without channels");
    /* The sum reads every byte of the image, so that a sanitizer reports an allocation that is too
     * small. */
    const uint8_t *pixels = image->pixels;
    volatile uint8_t sum = 0;
    for (size_t i = 0; i < kiln_asset_image_bytes(image); i++)
        sum = (uint8_t)(sum + pixels[i]);
    kiln_asset_image_destroy(&image);
    return true;
}

#endif
