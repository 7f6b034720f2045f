/* This file makes the picture that a file means of the numbers that it stores: in sRGB, and
 * upright. */
#include <stdlib.h>

#include "base/error.h"
#include "decode.h"
#include "values.h"

void decode_find_alpha(struct kiln_asset_image *image)
{
    const uint8_t *pixel = image->pixels;
    const size_t pixels = (size_t)image->width * image->height;
    image->channels = 3;
    for (size_t i = 0; i < pixels && image->channels == 3; i++)
        image->channels = pixel[4 * i + 3] != 255 ? 4 : 3;
}

/* Shows ink as Pillow does where there is no profile: white less the ink of each colour, times
 * white less black. Each number is white less ink. */
static void show_ink(struct kiln_asset_image *image)
{
    uint8_t *pixel = image->pixels;
    const uint8_t *end = pixel + kiln_asset_image_bytes(image);
    for (; pixel < end; pixel += 4) {
        for (int c = 0; c < 3; c++) {
            const uint32_t product = (255u - pixel[c]) * pixel[3] + 128u;
            pixel[c] = (uint8_t)(pixel[3] - ((product + (product >> 8)) >> 8));
        }
    }
}

/* show_deep_ink is show_ink for numbers of 16 bits. */
static void show_deep_ink(struct kiln_asset_image *image)
{
    uint16_t *pixel = image->pixels;
    const uint16_t *end = pixel + 4 * (size_t)image->width * image->height;
    for (; pixel < end; pixel += 4) {
        for (int c = 0; c < 3; c++) {
            const uint64_t product = (uint64_t)(65535u - pixel[c]) * pixel[3];
            pixel[c] = (uint16_t)(pixel[3] - (product + 32767u) / 65535u);
        }
    }
}

/* Puts alpha in the place of black. */
static void put_alpha(struct kiln_asset_image *image, const void *alpha)
{
    const size_t count = (size_t)image->width * image->height;
    uint8_t *bytes = image->pixels;
    uint16_t *words = image->pixels;
    for (size_t i = 0; i < count; i++) {
        if (image->type == KILN_IMAGE_U16)
            words[4 * i + 3] = alpha ? ((const uint16_t *)alpha)[i] : 65535;
        else
            bytes[4 * i + 3] = alpha ? ((const uint8_t *)alpha)[i] : 255;
    }
}

/* ---- associated alpha ------------------------------------------------------------------------ */

/* Divides colours by their alpha, or by the brightest of them where that is more, so that a profile
 * converts colours and not their products. Returns the divisor of each pixel, which the caller
 * frees, or NULL. */
static uint16_t *divide_by_alpha(struct kiln_asset_image *image)
{
    const size_t count = (size_t)image->width * image->height;
    const uint32_t full = decode_full(image);
    uint16_t *divisors = malloc(count * sizeof *divisors);
    for (size_t i = 0; divisors && i < count; i++) {
        uint32_t most = 0;
        for (size_t c = 0; c < 4; c++) {
            const uint32_t value = decode_value(image, 4 * i + c);
            most = value > most ? value : most;
        }
        divisors[i] = (uint16_t)most;
        for (size_t c = 0; c < 3 && most > 0; c++) {
            const uint64_t product = (uint64_t)decode_value(image, 4 * i + c) * full;
            decode_set_value(image, 4 * i + c, (uint32_t)((product + most / 2) / most));
        }
    }
    return divisors;
}

static void multiply_again(struct kiln_asset_image *image, const uint16_t *divisors)
{
    const size_t count = (size_t)image->width * image->height;
    const uint32_t full = decode_full(image);
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < 3; c++) {
            const uint64_t product = (uint64_t)decode_value(image, 4 * i + c) * divisors[i];
            decode_set_value(image, 4 * i + c, (uint32_t)((product + full / 2) / full));
        }
    }
}

/* ---- colour ---------------------------------------------------------------------------------- */

/* The enum tells whether the colours of a picture were converted to sRGB. */
enum shown { SHOWN, UNKNOWN, FAILED };

/* Converts colours by a profile with tables, or else by `color`. */
static enum shown convert(struct kiln_asset_image *image, const struct decode_meaning *meaning,
                          const struct kiln_color *color)
{
    uint16_t *divisors = NULL;
    if (image->premultiplied) {
        divisors = divide_by_alpha(image);
        if (!divisors)
            return FAILED;
    }
    const bool ok =
        color ? kiln_color_convert(color, image) : decode_profile_convert(image, meaning);
    if (divisors)
        multiply_again(image, divisors);
    free(divisors);
    return ok ? SHOWN : color ? FAILED : UNKNOWN;
}

static enum shown show_color(const struct kiln_color *color, struct kiln_asset_image *image)
{
    return kiln_color_is_srgb(color) ? SHOWN : convert(image, NULL, color);
}

/* Converts the picture by the profile of its file. */
static enum shown show_profile(struct decode_picture *picture, struct kiln_asset_image *image,
                               const struct decode_meaning *meaning)
{
    struct kiln_color color;
    const uint32_t channels = meaning->ink ? 4 : image->channels < 3 ? 1 : 3;
    switch (decode_icc(meaning->profile, meaning->profile_size, channels, &color)) {
    case DECODE_PROFILE_NONE:
        break;
    case DECODE_PROFILE_COLOR:
        return show_color(&color, image);
    case DECODE_PROFILE_TABLES:
        picture->needs_other = !decode_profile_is_ready();
        return picture->needs_other ? FAILED : convert(image, meaning, NULL);
    }
    return UNKNOWN;
}

/* Shows ink that no profile has turned into colours. */
static void show_plain_ink(struct kiln_asset_image *image)
{
    if (image->type == KILN_IMAGE_U16)
        show_deep_ink(image);
    else
        show_ink(image);
}

bool decode_show(struct decode_picture *picture, struct kiln_asset_image *image,
                 const struct decode_meaning *meaning)
{
    enum shown shown = UNKNOWN;
    if (!picture->raw && meaning->profile)
        shown = show_profile(picture, image, meaning);
    if (!picture->raw && meaning->color && shown == UNKNOWN)
        shown = show_color(meaning->color, image);
    if (meaning->ink && shown == UNKNOWN)
        show_plain_ink(image);
    if (meaning->ink)
        put_alpha(image, meaning->ink_alpha);
    if (picture->needs_other)
        return kiln_error_set(picture->error, KILN_INVALID_INPUT,
                              "a colour profile with tables cannot be applied to an animation");
    return (shown != FAILED && (picture->raw || decode_turn(image, meaning->orientation))) ||
           decode_out_of_memory(picture->error);
}
