/* This file makes the picture that a file means of the numbers that it stores: in sRGB, and
 * upright. */
#include "base/error.h"
#include "decode.h"

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

static void make_opaque(struct kiln_asset_image *image)
{
    uint8_t *pixel = image->pixels;
    const uint8_t *end = pixel + kiln_asset_image_bytes(image);
    for (; pixel < end; pixel += 4)
        pixel[3] = 255;
}

/* What became of the colours of a picture. */
enum shown { SHOWN, UNKNOWN, FAILED };

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
        return kiln_color_is_srgb(&color) || kiln_color_convert(&color, image) ? SHOWN : FAILED;
    case DECODE_PROFILE_TABLES:
        picture->needs_profile = !decode_profile_is_ready();
        if (picture->needs_profile)
            return FAILED;
        return decode_profile_convert(image, meaning) ? SHOWN : UNKNOWN;
    }
    return UNKNOWN;
}

static enum shown show_color(const struct kiln_color *color, struct kiln_asset_image *image)
{
    return kiln_color_is_srgb(color) || kiln_color_convert(color, image) ? SHOWN : FAILED;
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
        show_ink(image);
    if (meaning->ink)
        make_opaque(image);
    if (picture->needs_profile)
        return kiln_error_set(picture->error, KILN_INVALID_INPUT,
                              "a colour profile with tables cannot be applied to an animation");
    return (shown != FAILED && (picture->raw || decode_turn(image, meaning->orientation))) ||
           decode_out_of_memory(picture->error);
}
