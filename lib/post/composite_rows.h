/* This header declares the loop of composite=cpu over rows. */
#ifndef KILN_POST_COMPOSITE_ROWS_H
#define KILN_POST_COMPOSITE_ROWS_H

#include "base/simd.h"
#include "post/magnify.h"

/* Describes the pictures that are composed and the format of the result. */
struct kiln_composite_rows {
    uint32_t width; /* of all pictures except the glow */
    struct kiln_compose_light light;
    const float *glow; /* NULL: none */
    const struct kiln_magnifier *magnifier;
    float strength, exposure; /* strength: of the glow */
    enum kiln_tonemap tonemap;
    bool dither, texture; /* texture: as of struct kiln_composite_params */
    uint32_t frame, bits;
    void *display; /* RGBA, `bits` bits a channel */
    float *beauty; /* NULL if no linear picture is wanted */
};

/* Composes rows begin .. end - 1 of the struct kiln_composite_rows that context points to; it is a
 * function for kiln_threads_try. */
typedef void kiln_composite_rows_run(void *context, size_t begin, size_t end, uint32_t worker);
KILN_SIMD_DECLARE(kiln_composite_rows_run, kiln_composite_rows_run);

#endif
