/* Holds a picture on the host with mip levels, for drawing without GL. asset/image/texture.h has
 * the same in GL. */
#ifndef KILN_ASSET_IMAGE_PYRAMID_H
#define KILN_ASSET_IMAGE_PYRAMID_H

#include <stddef.h>
#include <stdint.h>

#include "asset/loader/loader.h"

enum { KILN_PYRAMID_LEVELS = 15 }; /* levels of the largest image */

/* Linear light as half floats, rows from the top. A texel has four; the fourth is 0 unless the
 * pyramid was created from texels. */
struct kiln_pyramid {
    uint32_t width, height, levels;
    uint32_t widths[KILN_PYRAMID_LEVELS], heights[KILN_PYRAMID_LEVELS];
    /* index of the first texel of each level, the finest level first */
    uint32_t first[KILN_PYRAMID_LEVELS];
    uint16_t (*texels)[4];
};

/* Loads an image file, of the formats and with the errors of kiln_texture_init. Beyond its left and
 * right edges the picture repeats; with repeats_y it does so also beyond the upper and lower ones.
 * NULL with an error. */
struct kiln_pyramid *kiln_pyramid_load(struct kiln_loader *loader, const char *path, bool repeats_y,
                                       struct kiln_error *error);
/* kiln_pyramid_create makes a black pyramid, or NULL when memory is short. kiln_pyramid_texels
 * counts the texels of all levels. kiln_pyramid_set sets their values, from 0 to 65504, level by
 * level. */
struct kiln_pyramid *kiln_pyramid_create(uint32_t width, uint32_t height);

/* Returns the bytes of the texels of a picture of width * height pixels. */
uint64_t kiln_pyramid_bytes(uint32_t width, uint32_t height);
size_t kiln_pyramid_texels(const struct kiln_pyramid *pyramid);
void kiln_pyramid_set(struct kiln_pyramid *pyramid, const float (*texels)[4]);
void kiln_pyramid_destroy(struct kiln_pyramid **pyramid);

#endif
