/* What is not judged of a picture: one byte a pixel. */
#ifndef KILN_COMPARE_MASK_H
#define KILN_COMPARE_MASK_H

#include "compare/subject.h"

/* Zero-initialised is of no size; make fills it, finish frees it. */
struct kiln_mask {
    uint32_t width, height;
    uint8_t *masked; /* 1 where nothing is judged; rows from the top */
};

/* All masks together, for pictures of that size; what it was for another size is replaced. Black
 * pixels of a mask picture are masked, whatever their alpha. False with KILN_USAGE when nothing is
 * left to judge, KILN_INVALID_INPUT when a mask picture cannot be read or has another size,
 * KILN_DEVICE_FAILED when memory is short. */
bool kiln_mask_make(struct kiln_mask *mask, const struct kiln_compare_mask *masks, size_t count,
                    uint32_t width, uint32_t height, struct kiln_error *error);
void kiln_mask_finish(struct kiln_mask *mask);

/* Takes the masked pixels of the test from the reference; both have the mask's size. */
void kiln_mask_apply(const struct kiln_mask *mask, const struct kiln_subject *reference,
                     struct kiln_subject *test);

#endif
