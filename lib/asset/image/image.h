/* Pictures in: textures and figures, decoded by FFmpeg's decoders alone. The format is told by the
 * file's first bytes, never by its name, and no demuxer or protocol is involved, so an image can
 * not make kiln open anything else. */
#ifndef KILN_ASSET_IMAGE_IMAGE_H
#define KILN_ASSET_IMAGE_IMAGE_H

#include "kiln.h"

enum {
    KILN_MAX_IMAGE_EDGE = 16384,      /* pixels a side */
    KILN_MAX_IMAGE_PIXELS = 1 << 26,  /* width * height */
    KILN_MAX_IMAGE_BYTES = 256 << 20, /* of the file */
};

enum kiln_image_type {
    KILN_IMAGE_U8,  /* uint8_t, 0..255 */
    KILN_IMAGE_U16, /* uint16_t, 0..65535, host byte order */
    KILN_IMAGE_F32, /* float */
};

/* RGBA, rows from the top, tightly packed. Sources without alpha get the full value. */
struct kiln_asset_image {
    uint32_t width, height;
    uint32_t channels; /* of the source: 1 grey, 2 grey and alpha, 3 colour, 4 colour and alpha */
    enum kiln_image_type type;
    bool srgb;          /* encoded with sRGB's transfer function; else linear */
    bool premultiplied; /* colour is already multiplied by alpha (EXR) */
    void *pixels;
};

/* Decodes a PNG, JPEG, WebP, TIFF, BMP or EXR file, or returns NULL: KILN_IO when it cannot be
 * read, KILN_INVALID_INPUT with what was found and what is allowed when it is not a regular file,
 * not such an image, broken or truncated, or beyond the limits above (found before memory is taken
 * for its pixels), KILN_DEVICE_FAILED when memory is short. The caller destroys it. */
struct kiln_asset_image *kiln_asset_image_load(const char *path, struct kiln_error *error);

/* The same for one layer of a file: EXR files have several, of which "beauty" is the picture; other
 * formats have that one alone. KILN_INVALID_INPUT, too, when there is no such layer. */
struct kiln_asset_image *kiln_asset_image_load_layer(const char *path, const char *layer,
                                                     struct kiln_error *error);

/* As the first, from bytes in memory; name stands for the file in messages. */
struct kiln_asset_image *kiln_asset_image_parse(const void *bytes, size_t size, const char *name,
                                                struct kiln_error *error);
void kiln_asset_image_destroy(struct kiln_asset_image **image);

/* Whether load would succeed; decodes the whole image to know. Its bytes and pixels are counted in
 * the budget: KILN_OVER_LIMIT before memory is taken for them. */
bool kiln_asset_image_check(const char *path, struct kiln_budget *budget, struct kiln_error *error);

#endif
