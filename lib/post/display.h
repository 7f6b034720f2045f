/* This header declares the conversion of a linear picture, such as an EXR file holds, to the pixels
 * of a display, as the composite stage makes them. */
#ifndef KILN_POST_DISPLAY_H
#define KILN_POST_DISPLAY_H

#include "base/thread.h"
#include "scene/scene.h"

struct kiln_display_params {
    uint32_t width, height, bits; /* bits a channel: 8 or 16 */
    float exposure;               /* stops */
    enum kiln_tonemap tonemap;
    bool texture;   /* as of struct kiln_composite_params */
    uint32_t frame; /* seeds the dither noise, which differs from frame to frame */
};

/* Converts `light` (RGBA, linear, premultiplied) to `display` (RGBA in sRGB with straight alpha).
 * Both have rows from the top. The pixels are the same on every machine, for any number of
 * threads. */
bool kiln_display_make(struct kiln_threads *threads, const struct kiln_display_params *params,
                       const float *light, void *display, struct kiln_error *error);

#endif
