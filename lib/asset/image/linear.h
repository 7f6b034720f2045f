/* Converts the pixels of an image file to linear light. */
#ifndef KILN_ASSET_IMAGE_LINEAR_H
#define KILN_ASSET_IMAGE_LINEAR_H

#include "asset/image/image.h"

/* Decodes a value from 0 to 1 by sRGB's transfer function, IEC 61966-2-1. */
float kiln_decode_srgb(float x);

/* Returns the linear light, multiplied by alpha, of a number of an image and its pixel's alpha,
 * each as 0 to 1. */
float kiln_light_of(const struct kiln_asset_image *image, float x, float alpha);

/* Converts row y to `width` RGB triples, 0 to 65504, the same on every machine. Transparent parts
 * are black. */
void kiln_linear_row(const struct kiln_asset_image *image, uint32_t y, float *rgb);

#endif
