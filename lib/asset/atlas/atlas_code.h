/* Declares the inner loops of atlas.c for each width of vectors. */
#ifndef KILN_ASSET_ATLAS_ATLAS_CODE_H
#define KILN_ASSET_ATLAS_ATLAS_CODE_H

#include "base/simd.h"

struct kiln_atlas_code {
    /* Stores a cell of edge x edge RGBA floats in 8 bits, and each level after it, down to one
     * texel; edge is a power of two. kind: as in struct kiln_atlas_range. `cell` is overwritten. */
    void (*store_cell)(float *cell, uint32_t edge, uint32_t kind, uint8_t *texels);
};
KILN_SIMD_DECLARE(const struct kiln_atlas_code, kiln_atlas);

#endif
