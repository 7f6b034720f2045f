/* Converts a decoded picture into one side of a comparison: linear light for FLIP, and levels for
 * the metrics that count them. */
#ifndef KILN_COMPARE_PICTURE_H
#define KILN_COMPARE_PICTURE_H

#include "asset/image/image.h"
#include "base/thread.h"

/* One side of a comparison, with rows from the top. A level is 1/255 of the way from black to white
 * in sRGB's encoding. Beyond white, the encoding's formula goes on; below black, it is mirrored. So
 * light of any strength has a level. */
struct kiln_compare_picture {
    uint32_t width, height;
    uint32_t channels; /* of the file: 1 grey, 2 grey and alpha, 3 colour, 4 colour and alpha */
    bool hdr;          /* made from floats: values may exceed white */
    float *linear;     /* three a pixel, multiplied by alpha */
    float *levels;     /* three a pixel, the levels of linear */
    float *alpha;      /* 0..1; NULL without alpha */
};

/* Converts a picture. masked, a byte a pixel or NULL, is 1 where values need not be finite: those
 * pixels become black. name stands for the picture in messages. NULL with KILN_INVALID_INPUT when
 * another value is not finite (the message says where), KILN_DEVICE_FAILED when memory is short. */
struct kiln_compare_picture *kiln_compare_picture_create(const struct kiln_asset_image *image,
                                                         const uint8_t *masked, const char *name,
                                                         struct kiln_threads *threads,
                                                         struct kiln_error *error);
void kiln_compare_picture_destroy(struct kiln_compare_picture **picture);

/* Checks that sizes and channels are equal. Returns false with KILN_FRAME_FAILED and a message that
 * names them. */
bool kiln_compare_picture_match(const struct kiln_compare_picture *reference,
                                const struct kiln_compare_picture *test, struct kiln_error *error);

#endif
