/* Numbers of pixels as files store them, for readers and for what follows them. */
#ifndef KILN_DECODE_VALUES_H
#define KILN_DECODE_VALUES_H

#include <string.h>

#include "asset/image/image.h"

/* Returns the largest number of an image of integers. */
static inline uint32_t decode_full(const struct kiln_asset_image *image)
{
    return image->type == KILN_IMAGE_U16 ? 65535 : 255;
}

/* Returns number `at` of an image of integers, which has four for each pixel. */
static inline uint32_t decode_value(const struct kiln_asset_image *image, size_t at)
{
    return image->type == KILN_IMAGE_U16 ? ((const uint16_t *)image->pixels)[at]
                                         : ((const uint8_t *)image->pixels)[at];
}

/* Replaces number `at` of an image of integers. */
static inline void decode_set_value(struct kiln_asset_image *image, size_t at, uint32_t value)
{
    if (image->type == KILN_IMAGE_U16)
        ((uint16_t *)image->pixels)[at] = (uint16_t)value;
    else
        ((uint8_t *)image->pixels)[at] = (uint8_t)value;
}

/* Returns the float of these bits. */
static inline float decode_float(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Returns the value of a half float. Each has an equal float. The product moves the exponent, also
 * that of a subnormal half float, and is exact. */
static inline float decode_half(uint32_t half)
{
    const uint32_t sign = (half & 0x8000u) << 16, size = (half & 0x7fffu) << 13;
    if ((half & 0x7c00u) == 0x7c00u)
        return decode_float(sign | 0x7f800000u | size);
    return decode_float(sign | size) * 0x1p112f;
}

#endif
