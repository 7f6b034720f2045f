/* Makes and applies masks, which mark the pixels of a picture that are not judged, by one byte a
 * pixel. */
#ifndef KILN_COMPARE_MASK_H
#define KILN_COMPARE_MASK_H

#include "compare/picture.h"

/* A mask that is zero-initialised has no size; kiln_mask_make fills it, kiln_mask_finish frees it.
 */
struct kiln_mask {
    uint32_t width, height;
    uint8_t *masked; /* 1 for pixels that are not judged; rows from the top */
};

/* Merges all masks into one for pictures of the given size, in place of an earlier one. Black
 * pixels of a mask picture are masked, whatever their alpha. False with KILN_USAGE when nothing is
 * left to judge, KILN_INVALID_INPUT when a mask picture cannot be read or has another size,
 * KILN_DEVICE_FAILED when memory is short. */
bool kiln_mask_make(struct kiln_mask *mask, const struct kiln_compare_mask *masks, size_t count,
                    uint32_t width, uint32_t height, struct kiln_error *error);
void kiln_mask_finish(struct kiln_mask *mask);

/* Copies the masked pixels of the reference to the test; both have the mask's size. */
void kiln_mask_apply(const struct kiln_mask *mask, const struct kiln_compare_picture *reference,
                     struct kiln_compare_picture *test);

#endif
