/* Converts a decoded picture into one side of a comparison: linear light for FLIP, and levels for
 * the metrics that count them. */
#ifndef KILN_COMPARE_PICTURE_H
#define KILN_COMPARE_PICTURE_H

#include "asset/image/image.h"
#include "base/thread.h"

/* The enum tells whether a file has alpha and whether any pixel is transparent. */
enum kiln_file_alpha {
    KILN_ALPHA_NONE,
    KILN_ALPHA_SOLID, /* it has alpha, which is 1 everywhere; the picture's `alpha` is NULL */
    KILN_ALPHA_SOME,
};

/* One side of a comparison, with rows from the top. A level is 1/255 of the way from black to white
 * in sRGB's encoding. Beyond white, the encoding's formula goes on; below black, it is mirrored. So
 * light of any strength has a level. */
struct kiln_compare_picture {
    uint32_t width, height;
    bool hdr; /* made from floats: values may exceed white */
    enum kiln_file_alpha file_alpha;
    float *linear; /* three a pixel, multiplied by alpha */
    float *levels; /* three a pixel, the levels of linear */
    float *alpha;  /* 0..1; NULL without alpha */
};

/* Converts a picture. masked, a byte a pixel or NULL, is 1 where values need not be finite: those
 * pixels become black. name stands for the picture in messages. NULL with KILN_INVALID_INPUT when
 * another value is not finite (the message says where), KILN_DEVICE_FAILED when memory is short. */
struct kiln_compare_picture *kiln_compare_picture_create(const struct kiln_asset_image *image,
                                                         const uint8_t *masked, const char *name,
                                                         struct kiln_threads *threads,
                                                         struct kiln_error *error);
void kiln_compare_picture_destroy(struct kiln_compare_picture **picture);

/* Makes two pictures comparable: if one has alpha, the other gets one, which is 1 everywhere. False
 * when memory is short. */
bool kiln_compare_pictures_agree(struct kiln_compare_picture *const pictures[2],
                                 struct kiln_error *error);

/* Returns a sentence if the files differ in alpha; else "". */
const char *kiln_compare_alpha_note(const struct kiln_compare_picture *reference,
                                    const struct kiln_compare_picture *test);

/* Checks that the sizes are equal. Returns false with KILN_FRAME_FAILED and a message that names
 * them. */
bool kiln_compare_picture_match(const struct kiln_compare_picture *reference,
                                const struct kiln_compare_picture *test, struct kiln_error *error);

#endif
