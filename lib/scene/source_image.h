/* Makes the cells of a source out of an image. */
#ifndef KILN_SCENE_SOURCE_IMAGE_H
#define KILN_SCENE_SOURCE_IMAGE_H

#include "scene/source_mesh.h"

/* What the pixels of an image count. */
struct kiln_pixel_counts {
    uint32_t above; /* the number of pixels that count more than the threshold */
    double most;    /* what a pixel counts at most, 0 to 1 */
    bool by_alpha;  /* false: the whole image is opaque, and pixels count by their brightness */
};

/* Finds the pixels of an image that count more than a threshold, from 0 to 1. A pixel counts by its
 * alpha, or by its brightness if all of the image is opaque. */
struct kiln_pixel_counts kiln_source_count_pixels(const struct kiln_asset_image *image,
                                                  double threshold);

/* Fills the cells of a source with these pixels, `count` of them, by how much they count. The image
 * is `width` m wide, upright around the origin. colored: the source gets the pixels' colours, too.
 * False when memory is short. */
bool kiln_source_fill_image(struct kiln_arena *arena, const struct kiln_asset_image *image,
                            double threshold, double width, bool colored, uint32_t count,
                            struct kiln_source *source);

#endif
