/* Gives the pixels of an image file as linear light. */
#ifndef KILN_ASSET_IMAGE_LINEAR_H
#define KILN_ASSET_IMAGE_LINEAR_H

#include "asset/image/image.h"

/* IEC 61966-2-1, of a value from 0 to 1. */
float kiln_decode_srgb(float x);

/* Row y as width RGB triples, 0 to 65504, the same on every machine; transparent parts are black.
 */
void kiln_linear_row(const struct kiln_asset_image *image, uint32_t y, float *rgb);

#endif
