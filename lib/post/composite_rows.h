/* This header declares the loop of composite=cpu over rows. */
#ifndef KILN_POST_COMPOSITE_ROWS_H
#define KILN_POST_COMPOSITE_ROWS_H

#include "base/simd.h"
#include "post/magnify.h"

/* Describes the pictures that are composed and the format of the result. */
struct kiln_composite_rows {
    uint32_t width; /* of all pictures but the glow */
    struct kiln_compose_light light;
    const float *glow; /* NULL: none */
    const struct kiln_magnifier *magnifier;
    float strength, exposure; /* strength: of the glow */
    enum kiln_tonemap tonemap;
    bool dither;
    uint32_t frame, bits;
    void *display; /* four channels of bits a pixel */
    float *beauty; /* NULL unless asked for */
};

/* Rows begin to end of the kiln_composite_rows that context points to, for kiln_threads_for. */
typedef void kiln_composite_rows_run(void *context, size_t begin, size_t end, uint32_t worker);
KILN_SIMD_DECLARE(kiln_composite_rows_run, kiln_composite_rows_run);

#endif
