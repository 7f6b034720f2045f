/* Declares the parts of kiln-decode's reader of OpenEXR files: exr.c opens a file and makes the
 * picture, exr_layer.c finds the channels of a layer, exr_pixels.c decodes them by OpenEXR's C
 * core, exr_more.c by OpenEXR's C++, and exr_chroma.c computes colours from luminance and chroma.
 */
#ifndef KILN_DECODE_EXR_H
#define KILN_DECODE_EXR_H

#include <openexr.h>

#include "decode.h"

/* Channels of a layer by what they hold. The first four are the components of a pixel: a layer of
 * one component, such as depth, has it as EXR_RED. */
enum exr_role { EXR_RED, EXR_GREEN, EXR_BLUE, EXR_ALPHA, EXR_RY, EXR_BY, EXR_ROLES };

struct exr_layer {
    const char *names[EXR_ROLES]; /* of the channels in the file; NULL: the layer lacks it */
    int sampling;                 /* of RY and BY: pixels a sample and axis, 1 or 2 */
    bool grey;                    /* EXR_RED is all that the layer has, besides alpha */
    bool is_color;                /* the numbers are light of the file's primaries */
};

/* Pixels inside of both edges. */
struct exr_box {
    int32_t left, top;
    uint32_t width, height;
};

struct exr_reading {
    struct decode_picture *picture;
    exr_context_t file;
    int part;
    struct exr_layer layer;
    struct exr_box data, display;
    struct kiln_asset_image *image; /* of the data window, until exr.c puts it into the display's */
    float *chroma[2];               /* samples of RY and BY, or NULL */
    uint32_t chroma_width, chroma_height;
    double inexact; /* a whole number of a channel that no float equals; 0: none was found */
};

/* Fills the error for a code of OpenEXR. Returns false. */
bool decode_exr_fail(const struct exr_reading *reading, exr_result_t code);

/* Finds the part and the channels of the layer that is asked for. */
bool decode_exr_find_layer(struct exr_reading *reading);

/* Decodes the channels of the layer into the image and the planes of chroma. */
bool decode_exr_pixels(struct exr_reading *reading);

/* Returns where the first sample of a channel lies, and the distances to the next one to the right
 * and below, in floats. NULL: the layer has no such channel. */
float *decode_exr_target(const struct exr_reading *reading, enum exr_role role, size_t *step,
                         size_t *stride);

/* Decodes the channels of the layer by OpenEXR's C++ library. deep: flattens the samples of a deep
 * part. */
bool decode_exr_more(struct exr_reading *reading, bool deep);
bool decode_exr_more_is_ready(void);

/* Computes red, green and blue of luminance, which is the red of the image, and chroma. weights:
 * the luminance of each primary. */
bool decode_exr_chroma(struct exr_reading *reading, const double weights[3]);

#endif
