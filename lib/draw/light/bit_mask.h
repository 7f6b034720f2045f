/* This header declares a mask of bits that triangles set: KILN_BIT_CELL x KILN_BIT_CELL bits for
 * each texel of a picture. The part of a texel's bits that are set is the part that the triangles
 * cover. */
#ifndef KILN_DRAW_LIGHT_BIT_MASK_H
#define KILN_DRAW_LIGHT_BIT_MASK_H

#include <stddef.h>
#include <stdint.h>

enum { KILN_BIT_CELL = 4 };

/* Describes a square mask. The caller owns the rows and clears them. */
struct kiln_bit_mask {
    uint64_t *rows;
    size_t words; /* of a row */
    int32_t edge; /* bits of a row, and rows */
};

/* Sets the bits whose centres lie in a triangle, whichever way it faces. p: x, y of its corners, in
 * bits; the part outside of the mask is left out. */
void kiln_bit_mask_add(const struct kiln_bit_mask *mask, const float p[3][2]);

/* Returns the part of a texel's bits that are set, 0 to 1. */
float kiln_bit_mask_part(const struct kiln_bit_mask *mask, size_t x, size_t y);

#endif
