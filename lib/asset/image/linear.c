/* This file decodes the pixels of a picture to linear light, one row at a time, so that no second
 * picture lies in memory. */
#include "asset/image/linear.h"

#include "shared/exact.h"

static const float MOST = 65504.0f; /* largest half float */

float kiln_decode_srgb(float x)
{
    return x <= 0.04045f ? x / 12.92f : exact_pow((x + 0.055f) / 1.055f, 2.4f);
}

/* Returns the light of a number that is multiplied by alpha in its encoding. Beyond alpha, it adds
 * what its own light is beyond that of alpha, so that light without cover is its own, and what is
 * as bright as alpha is white. */
static float associated_light(float x, float alpha)
{
    if (x <= alpha)
        return alpha > 0.0f ? alpha * kiln_decode_srgb(x / alpha) : 0.0f;
    return alpha + (kiln_decode_srgb(x) - kiln_decode_srgb(alpha));
}

float kiln_light_of(const struct kiln_asset_image *image, float x, float alpha)
{
    if (image->premultiplied)
        return image->srgb ? associated_light(x, alpha) : x;
    return alpha * (image->srgb ? kiln_decode_srgb(x) : x);
}

static float decode(const struct kiln_asset_image *image, size_t at)
{
    if (image->type == KILN_IMAGE_F32)
        return ((const float *)image->pixels)[at];
    if (image->type == KILN_IMAGE_U16)
        return (float)((const uint16_t *)image->pixels)[at] / 65535.0f;
    return (float)((const uint8_t *)image->pixels)[at] / 255.0f;
}

void kiln_linear_row(const struct kiln_asset_image *image, uint32_t y, float *rgb)
{
    for (uint32_t x = 0; x < image->width; x++, rgb += 3) {
        size_t at = ((size_t)y * image->width + x) * 4;
        const float alpha = decode(image, at + 3);
        for (size_t c = 0; c < 3; c++) {
            const float value = kiln_light_of(image, decode(image, at + c), alpha);
            rgb[c] = value > 0.0f ? fminf(value, MOST) : 0.0f; /* a NaN becomes 0 */
        }
    }
}
