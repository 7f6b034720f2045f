/* Checks and takes the pictures that kiln-decode sends. */
#ifndef KILN_ASSET_IMAGE_RECEIVED_H
#define KILN_ASSET_IMAGE_RECEIVED_H

#include "asset/image/image.h"

struct kiln_received {
    struct kiln_loader *loader; /* counts pixels; may be NULL */
    struct kiln_helper *helper;
    const char *name; /* of the file, for messages */
    bool finite;      /* floats that are none are refused */
    uint64_t counted; /* pixels that the budget has already: those of the largest frame so far */
    uint64_t refused; /* set: pixels of a picture that has more than the budget has left */
};

/* How many pixels the budget of a scene has left, at most those of an image. */
uint64_t kiln_received_most_pixels(const struct kiln_loader *loader);

/* Waits for a picture, or for another of the expected answers (bits): NULL then, and no error. */
struct kiln_asset_image *kiln_received_image(struct kiln_received *received, unsigned expected,
                                             struct kiln_error *reason);

/* Says what is wrong with the file of that name: "NAME: reason", or the budget's own words. Returns
 * false. */
bool kiln_received_fail(const struct kiln_received *received, const struct kiln_error *reason,
                        struct kiln_error *error);

#endif
