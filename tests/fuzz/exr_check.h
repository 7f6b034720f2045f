/* Decodes the layers of an EXR file, for the fuzz targets of EXR. */
#ifndef KILN_FUZZ_EXR_CHECK_H
#define KILN_FUZZ_EXR_CHECK_H

#include <stdio.h>

#include "asset/image/layers_in.h"
#include "decode.h"
#include "image_check.h"

/* Each layer must have a name of its own, in order. */
static inline void check_layer(void *user, const char *name, bool data,
                               struct kiln_asset_image *image)
{
    char *last = user;
    struct kiln_error error = {0};
    require(*name && (!*last || kiln_order_layers(last, name) < 0), "layers are out of order");
    require(data || image->type != KILN_IMAGE_U32, "colours are whole numbers");
    fuzz_taken = check_image(image, &error) || fuzz_taken;
    snprintf(last, KILN_LAYER_NAME_SIZE, "%s", name);
}

/* Requires that each layer that a file may have is decoded to an image within the size limits, or
 * refused with an error. */
static inline void check_exr(const uint8_t *data, size_t size)
{
    static const char *const layers[] = {"beauty", "fire", "depth", "N", "left.id"};
    fuzz_taken = false;
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) {
        struct kiln_error error = {0};
        struct decode_picture picture = {.bytes = data,
                                         .size = size,
                                         .format = KILN_PICTURE_EXR,
                                         .layer = layers[i],
                                         .most_pixels = KILN_MAX_IMAGE_PIXELS,
                                         .error = &error};
        fuzz_taken = check_image(decode_exr(&picture), &error) || fuzz_taken;
    }
    struct kiln_error error = {0};
    char last[KILN_LAYER_NAME_SIZE] = "";
    struct decode_picture all = {.bytes = data,
                                 .size = size,
                                 .format = KILN_PICTURE_EXR,
                                 .layer = "",
                                 .layers = true,
                                 .most_pixels = KILN_MAX_IMAGE_PIXELS,
                                 .error = &error};
    const bool ok = decode_exr_layers(&all, check_layer, last);
    require(all.needs_other || ok == (error.code == KILN_OK), "a failure has no error");
}

#endif
