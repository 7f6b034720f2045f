/* Holds a picture on the host with mip levels, for drawing without GL; asset/image/texture.h is its
 * like in GL. */
#ifndef KILN_ASSET_IMAGE_PYRAMID_H
#define KILN_ASSET_IMAGE_PYRAMID_H

#include <stddef.h>
#include <stdint.h>

#include "asset/loader/loader.h"

enum { KILN_PYRAMID_LEVELS = 15 }; /* of the largest image */

/* Linear light as half floats, four a texel, of which the last is unused but by who made it from
 * texels; rows from the top. */
struct kiln_pyramid {
    uint32_t width, height, levels;
    uint32_t widths[KILN_PYRAMID_LEVELS], heights[KILN_PYRAMID_LEVELS];
    size_t first[KILN_PYRAMID_LEVELS]; /* texel of each level, the finest first */
    uint16_t (*texels)[4];
};

/* Loads an image file as kiln_texture_init does. repeats_y: the picture goes on beyond its upper
 * and lower edges, as it does beyond the others. NULL with an error. */
struct kiln_pyramid *kiln_pyramid_load(struct kiln_loader *loader, const char *path, bool repeats_y,
                                       struct kiln_error *error);
/* A black one, or NULL when memory is short; its texels, those of all levels; and their values, in
 * its order, each from 0 to 65504. */
struct kiln_pyramid *kiln_pyramid_create(uint32_t width, uint32_t height);
size_t kiln_pyramid_texels(const struct kiln_pyramid *pyramid);
void kiln_pyramid_set(struct kiln_pyramid *pyramid, const float (*texels)[4]);
void kiln_pyramid_destroy(struct kiln_pyramid **pyramid);

#endif
