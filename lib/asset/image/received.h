/* Checks and takes the pictures that kiln-decode sends. */
#ifndef KILN_ASSET_IMAGE_RECEIVED_H
#define KILN_ASSET_IMAGE_RECEIVED_H

#include "asset/image/image.h"

struct kiln_received {
    struct kiln_loader *loader; /* counts pixels; may be NULL */
    struct kiln_helper *helper;
    const char *name; /* name of the file, for messages */
    bool finite;      /* true: pixels that are not finite are an error */
    /* pixels that the budget has counted already: those of the largest frame so far */
    uint64_t counted;
    uint64_t refused; /* result: pixels of a picture that the budget has no room for */
    bool needs_other; /* result: the answer was KILN_DECODE_NEEDS_OTHER */
};

/* Returns how many pixels the budget of a scene has left, at most the limit of one image. */
uint64_t kiln_received_most_pixels(const struct kiln_loader *loader);

/* Waits for a picture, or for another of the expected answers (a bit mask). Returns NULL without an
 * error for another expected answer. */
struct kiln_asset_image *kiln_received_image(struct kiln_received *received, unsigned expected,
                                             struct kiln_error *reason);

/* Reports the fault of the named file: "NAME: reason", or the budget's message. Returns false. */
bool kiln_received_fail(const struct kiln_received *received, const struct kiln_error *reason,
                        struct kiln_error *error);

#endif
