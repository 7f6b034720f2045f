/* This file finds how a picture is turned, in the Exif data of its file, and turns it upright
 * (CIPA DC-008-2023, 4.6.5.1.6). Broken data mean a picture that is upright. */
#include <stdlib.h>
#include <string.h>

#include "decode.h"

enum {
    ORIENTATION = 0x0112,
    SHORT = 3,
    ENTRY = 12, /* bytes of an entry of a directory */
};

struct exif {
    const uint8_t *bytes;
    size_t size;
    bool big; /* the high byte of a number comes first */
};

static uint32_t number16(const struct exif *exif, size_t at)
{
    const uint8_t *b = exif->bytes + at;
    return exif->big ? (uint32_t)(b[0] << 8 | b[1]) : (uint32_t)(b[1] << 8 | b[0]);
}

static uint32_t number32(const struct exif *exif, size_t at)
{
    const uint32_t first = number16(exif, at), second = number16(exif, at + 2);
    return exif->big ? first << 16 | second : second << 16 | first;
}

/* Finds the orientation. False: the data are broken. */
static bool find_orientation(struct exif *exif, uint32_t *orientation)
{
    const size_t size = exif->size;
    *orientation = 1;
    if (size < 14 || (memcmp(exif->bytes, "II*\0", 4) != 0 && memcmp(exif->bytes, "MM\0*", 4) != 0))
        return false;
    exif->big = exif->bytes[0] == 'M';
    const size_t first = number32(exif, 4);
    if (first > size - 2)
        return false;
    const uint32_t count = number16(exif, first);
    for (uint32_t i = 0; i < count; i++) {
        const size_t at = first + 2 + (size_t)ENTRY * i;
        if (at > size - ENTRY)
            return false;
        if (number16(exif, at) == ORIENTATION && number16(exif, at + 2) == SHORT) {
            const uint32_t found = number16(exif, at + 8);
            *orientation = found >= 1 && found <= 8 ? found : 1;
            return found <= 8; /* some cameras write 0 for an unknown one */
        }
    }
    return true;
}

uint32_t decode_exif_orientation(struct decode_picture *picture, const uint8_t *bytes, size_t size)
{
    struct exif exif = {.bytes = bytes, .size = size};
    uint32_t orientation;
    if (!find_orientation(&exif, &orientation))
        decode_warn(picture, DECODE_BROKEN_EXIF);
    return orientation;
}

bool decode_turn(struct kiln_asset_image *image, uint32_t orientation)
{
    if (orientation <= 1)
        return true;
    const bool swaps = orientation >= 5; /* rows become columns */
    const uint32_t width = swaps ? image->height : image->width;
    const uint32_t height = swaps ? image->width : image->height;
    const size_t bytes = kiln_asset_image_bytes(image);
    const size_t pixel = bytes / ((size_t)image->width * image->height);
    uint8_t *turned = malloc(bytes);
    if (!turned)
        return false;
    /* Whether the upright picture's left is at the stored picture's right or bottom, and so on. */
    const bool flips_x =
        orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
    const bool flips_y =
        orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
    const uint8_t *stored = image->pixels;
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            uint32_t column = swaps ? y : x, row = swaps ? x : y;
            column = flips_x ? image->width - 1 - column : column;
            row = flips_y ? image->height - 1 - row : row;
            memcpy(turned + ((size_t)y * width + x) * pixel,
                   stored + ((size_t)row * image->width + column) * pixel, pixel);
        }
    }
    free(image->pixels);
    image->pixels = turned;
    image->width = width;
    image->height = height;
    return true;
}
