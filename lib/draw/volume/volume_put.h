/* Declares how the planes of a picture of gas are put to images: under particles, to what glows,
 * and to the layers of an EXR file. */
#ifndef KILN_DRAW_VOLUME_VOLUME_PUT_H
#define KILN_DRAW_VOLUME_VOLUME_PUT_H

#include "draw/volume/volume.h"
#include "draw/volume/volume_march.h"

/* Describes an image that gets gas, and the picture of gas. */
struct kiln_volume_put {
    const struct kiln_volume_planes *planes;
    const uint8_t *touched; /* of each tile: gas was drawn there */
    uint32_t width;
    float *to;                       /* four floats a pixel */
    enum kiln_volume_light_of light; /* not for kiln_volume_put_layer_rows */
    bool keep;                       /* for kiln_volume_put_glow_rows: something was drawn before */
};

/* These functions have the form that kiln_threads_try takes; context: a kiln_volume_put. They write
 * rows [begin, end). */

/* Clears the planes; uses nothing but them and the width. */
void kiln_volume_clear_rows(void *context, size_t begin, size_t end, uint32_t worker);

/* Puts gas under premultiplied particles. */
void kiln_volume_put_under_rows(void *context, size_t begin, size_t end, uint32_t worker);

/* Puts the glow of flames over what glows. */
void kiln_volume_put_glow_rows(void *context, size_t begin, size_t end, uint32_t worker);

/* Writes the light of flames, and the opacity of the gas as alpha; zeros where there is none. */
void kiln_volume_put_layer_rows(void *context, size_t begin, size_t end, uint32_t worker);

#endif
