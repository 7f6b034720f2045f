/* Converts pictures to 8-bit PNG for browsers. Linear light x is tone-mapped by a fit of the ACES
 * curve (Narkowicz 2015), which is applied to 0.6 x as in HDR-FLIP. Black stays black, and light
 * far beyond white is compressed instead of clipped. */
#include "report/preview.h"

#include <math.h>
#include <string.h>

#include "asset/image/image.h"
#include "base/error.h"
#include "output/formats.h"

bool kiln_preview_is_plain(const unsigned char *bytes, size_t size)
{
    static const unsigned char signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    enum { DEPTH_OFFSET = 24 }; /* of the bit depth in IHDR, the first chunk */
    return size > DEPTH_OFFSET && memcmp(bytes, signature, sizeof signature) == 0 &&
           bytes[DEPTH_OFFSET] <= 8;
}

static float value_at(const struct kiln_asset_image *image, size_t index)
{
    switch (image->type) {
    case KILN_IMAGE_U8:
        return (float)((const uint8_t *)image->pixels)[index] / 255.0f;
    case KILN_IMAGE_U16:
        return (float)((const uint16_t *)image->pixels)[index] / 65535.0f;
    case KILN_IMAGE_U32: /* of layers of data, which are no previews */
    case KILN_IMAGE_F32:
        break;
    }
    return ((const float *)image->pixels)[index];
}

static float tone_map(float x)
{
    float y = 0.6f * x;
    return y * (2.51f * y + 0.03f) / (y * (2.43f * y + 0.59f) + 0.14f);
}

static float encode_srgb(float x)
{
    return x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1.0f / 2.4f) - 0.055f;
}

/* Converts 0 to 1 to a byte. Other values are clamped, and NaN becomes 0. */
static uint8_t to_byte(float x)
{
    return (uint8_t)(x > 0.0f ? (x < 1.0f ? x * 255.0f + 0.5f : 255.0f) : 0.0f);
}

static void convert(const struct kiln_asset_image *image, uint8_t *out)
{
    enum { BRIGHTEST = 65504 }; /* the largest half float; the curve is flat far below it */
    size_t pixels = (size_t)image->width * image->height;
    for (size_t i = 0; i < pixels; i++) {
        float alpha = value_at(image, 4 * i + 3);
        for (size_t c = 0; c < 3; c++) {
            float x = value_at(image, 4 * i + c);
            if (!image->srgb)
                x = x > 0.0f ? encode_srgb(tone_map(fminf(x, BRIGHTEST))) : 0.0f;
            out[4 * i + c] = to_byte(image->premultiplied ? x : x * alpha);
        }
        out[4 * i + 3] = 255;
    }
}

bool kiln_preview_write(const unsigned char *bytes, size_t size, const char *name,
                        struct kiln_temporary *file, struct kiln_error *error)
{
    struct kiln_asset_image *image = kiln_asset_image_parse(bytes, size, name, error);
    struct kiln_picture *picture =
        image ? kiln_picture_create(image->width, image->height, 8, NULL, NULL, 0, error) : NULL;
    if (picture)
        convert(image, picture->display);
    kiln_asset_image_destroy(&image);
    const struct kiln_output_params no_scene = {0};
    bool ok = picture && kiln_png_write(&no_scene, picture, file, NULL, error);
    kiln_picture_destroy(&picture);
    return ok;
}
