/* This file converts a composed linear picture to a display picture with the loops of
 * composite=cpu. */
#include "post/display.h"

#include "post/composite_rows.h"
#include "shared/exact.h"

enum { ROWS_AT_A_TIME = 8 };

bool kiln_display_make(struct kiln_threads *threads, const struct kiln_display_params *params,
                       const float *light, void *display, struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return false;
    struct kiln_composite_rows rows = {
        .width = params->width,
        .light = {.scene = light},
        .exposure = exact_exp2(params->exposure),
        .tonemap = params->tonemap,
        .dither = true,
        .texture = params->texture,
        .frame = params->frame,
        .bits = params->bits,
        .display = display,
    };
    return kiln_threads_try(threads, params->height, ROWS_AT_A_TIME,
                            KILN_SIMD_PICK(kiln_composite_rows_run, simd), &rows, error);
}
