/* Fuzzes the image loader: any bytes are an image within the limits or an error, never a crash. */
#include <stdio.h>
#include <stdlib.h>

#include "asset/image.h"
#include "fuzz.h"

static void require(bool condition, const char *what)
{
    if (!condition) {
        fprintf(stderr, "fuzz: %s\n", what);
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct kiln_error error = {0};
    struct kiln_asset_image *image = kiln_asset_image_parse(data, size, "fuzz", &error);
    if (!image) {
        require(error.code != KILN_OK && *error.message, "an error without a message");
        return 0;
    }
    require(image->width >= 1 && image->width <= KILN_MAX_IMAGE_EDGE && image->height >= 1 &&
                image->height <= KILN_MAX_IMAGE_EDGE &&
                image->width * image->height <= KILN_MAX_IMAGE_PIXELS,
            "an image beyond the limits");
    /* Every byte is there and was written: a sum that depends on them all. */
    static const size_t bytes[] = {
        [KILN_IMAGE_U8] = 4, [KILN_IMAGE_U16] = 8, [KILN_IMAGE_F32] = 16};
    const uint8_t *pixels = image->pixels;
    volatile uint8_t sum = 0;
    for (size_t i = 0; i < (size_t)image->width * image->height * bytes[image->type]; i++)
        sum = (uint8_t)(sum + pixels[i]);
    kiln_asset_image_destroy(&image);
    return 0;
}
