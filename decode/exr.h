/* Declares the parts of kiln-decode's reader of OpenEXR files: exr.c opens a file, exr_layer.c
 * finds the channels of a layer, exr_list.c all layers, exr_pixels.c decodes channels by OpenEXR's
 * C core, exr_more.c by OpenEXR's C++, exr_chroma.c computes colours from luminance and chroma, and
 * exr_show.c makes the picture. */
#ifndef KILN_DECODE_EXR_H
#define KILN_DECODE_EXR_H

#include <openexr.h>

#include "decode.h"
#include "exr_module.h"

/* Channels of a layer by what they hold. The first four are the components of a pixel: a layer of
 * one component, such as depth, has it as EXR_RED. */
enum exr_role { EXR_RED, EXR_GREEN, EXR_BLUE, EXR_ALPHA, EXR_RY, EXR_BY, EXR_ROLES };

struct exr_layer {
    const char *names[EXR_ROLES]; /* of the channels in the file; NULL: the layer lacks it */
    int sampling;                 /* of RY and BY: pixels a sample and axis, 1 or 2 */
    bool grey;                    /* EXR_RED is all that the layer has, besides alpha */
    bool is_color;                /* the numbers are light of the file's primaries */
    bool is_data;                 /* the numbers are no light, such as depths */
    bool is_whole;                /* the numbers stay whole numbers (KILN_IMAGE_U32) */
};

/* Pixels inside of both edges. */
struct exr_box {
    int32_t left, top;
    uint32_t width, height;
};

/* One layer, from its channels in the file to its picture. */
struct exr_reading {
    struct decode_picture *picture;
    exr_context_t file;
    int part;
    struct exr_layer layer;
    char name[KILN_LAYER_NAME_SIZE];
    struct exr_box data, display;
    struct kiln_asset_image *image; /* of the data window, until exr.c puts it into the display's */
    float *chroma[2];               /* samples of RY and BY, or NULL */
    uint32_t chroma_width, chroma_height;
    bool more;                   /* it is decoded by OpenEXR's C++ */
    enum kiln_openexr_deep deep; /* what becomes of lists of samples */
    double inexact; /* a whole number of a channel that no float equals; 0: none was found */
};

/* Fills the error for a code of OpenEXR. Returns false. */
bool decode_exr_fail(const struct exr_reading *reading, exr_result_t code);

/* Finds the part and the channels of the layer that is asked for. */
bool decode_exr_find_layer(struct exr_reading *reading);

/* Lists all layers of a file: each channel of each part belongs to one. *list gets a reading for
 * each, with part, layer and name, which the caller frees. */
bool decode_exr_list(const struct exr_reading *file, struct exr_reading **list, size_t *count);

/* Meanings of the last word of a channel's name. */
enum exr_word {
    EXR_WORD_R,
    EXR_WORD_G,
    EXR_WORD_B,
    EXR_WORD_A,
    EXR_WORD_Y,
    EXR_WORD_RY,
    EXR_WORD_BY,
    EXR_WORD_X,
    EXR_WORD_Z,
    EXR_WORD_U,
    EXR_WORD_V,
    EXR_WORD_W,
    EXR_WORD_COUNT,
};

struct exr_words {
    const char *channels[EXR_WORD_COUNT]; /* names of the channels that end in a word, or NULL */
};

/* Finds the channels that are called "PREFIX.WORD"; those of an empty prefix have no dot. */
struct exr_words decode_exr_words(const exr_attr_chlist_t *list, const char *prefix);

/* Chooses the channels of a layer from those with one prefix. A vector is X, Y and Z, or U, V and
 * W, of which the last may be missing. vectors: the layer may hold other things than light. False:
 * they make no layer. */
bool decode_exr_choose(const struct exr_words *words, bool vectors, struct exr_layer *layer);

/* Makes a layer of one channel. False: channel is NULL. */
bool decode_exr_choose_one(const char *channel, struct exr_layer *layer);

/* Says what the numbers of a layer of that name are, and checks that each pixel has its samples. */
bool decode_exr_describe(struct exr_reading *reading, const exr_attr_chlist_t *list);

/* Decodes the channels of layers of one part into their images and planes of chroma. */
bool decode_exr_pixels(struct exr_reading *readings, size_t count);

/* Takes memory for the numbers of a layer. */
bool decode_exr_make_planes(struct exr_reading *reading);

/* Makes the picture of the numbers. */
bool decode_exr_show(struct exr_reading *reading);

/* Returns where the first sample of a channel lies, and the distances to the next one to the right
 * and below, in floats. NULL: the layer has no such channel. */
float *decode_exr_target(const struct exr_reading *reading, enum exr_role role, size_t *step,
                         size_t *stride);

/* Decodes the channels of layers of one part, which are alike in `deep`, by OpenEXR's C++ library.
 */
bool decode_exr_more(struct exr_reading *readings, size_t count);
bool decode_exr_more_is_ready(void);

/* Computes red, green and blue of luminance, which is the red of the image, and chroma. weights:
 * the luminance of each primary. */
bool decode_exr_chroma(struct exr_reading *reading, const double weights[3]);

#endif
