/* Layers of OpenEXR files, by OpenEXR's C core. FFmpeg reads tiled files as well, but not those of
 * several layers, which kiln writes. */
#ifndef KILN_ASSET_IMAGE_EXR_IN_H
#define KILN_ASSET_IMAGE_EXR_IN_H

#include "asset/image/image.h"

/* What FFmpeg has to be asked for instead: files in tiles. */
bool kiln_exr_is_tiled(const void *bytes, size_t size);

/* Decodes the layer of that name from the first part that has it: "beauty" is R, G, B (and A), or
 * Y, without a name before them, "depth" is Z, any other one "NAME.R" and so on, or its one
 * channel. KILN_IMAGE_F32, linear, premultiplied, over the data window. NULL with
 * KILN_INVALID_INPUT when it has no such layer (the message lists what it has), is broken, cut
 * short, deep or subsampled, or beyond the limits of image.h; KILN_DEVICE_FAILED when memory is
 * short. */
struct kiln_asset_image *kiln_exr_parse(const void *bytes, size_t size, const char *name,
                                        const char *layer, struct kiln_error *error);

#endif
