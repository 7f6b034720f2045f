/* Declares how one cell of a procedural flipbook is made. Only builtin.c and texel_cell_simd.c
 * include this header. */
#ifndef KILN_ASSET_ATLAS_TEXEL_CELL_H
#define KILN_ASSET_ATLAS_TEXEL_CELL_H

#include "asset/atlas/builtin.h"
#include "asset/atlas/texel.h"

enum { TEXEL_CELL = TEXEL_ROW * TEXEL_ROW };

struct kiln_builtin_scratch {
    struct kiln_fluid_scratch fluid;
    float heat[TEXEL_CELL], x[TEXEL_CELL], y[TEXEL_CELL], weight[TEXEL_CELL];
};

struct texel_job {
    const struct builtin *builtin;
    const struct kiln_film_cell *gas; /* NULL: there is no gas */
    const struct texel_lobe *lobes;
    float time;
    uint32_t edge;
};

struct texel_code {
    /* Fills edge x edge RGBA floats. */
    void (*make_cell)(const struct texel_job *job, struct kiln_builtin_scratch *scratch,
                      float *pixels);
};
KILN_SIMD_DECLARE(const struct texel_code, kiln_texel);

#endif
