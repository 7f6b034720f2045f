/* Pictures in: textures and figures, decoded by kiln-decode. The format is told by the file's first
 * bytes, never by its name, and an image can not make anybody open anything else. A loader of NULL
 * stands for one that opens any file and ends its process after each. */
#ifndef KILN_ASSET_IMAGE_IMAGE_H
#define KILN_ASSET_IMAGE_IMAGE_H

#include "asset/loader/loader.h"

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

/* Bytes of all pixels, of which each has four values. */
static inline size_t kiln_asset_image_bytes(const struct kiln_asset_image *image)
{
    static const size_t pixel_bytes[] = {
        [KILN_IMAGE_U8] = 4, [KILN_IMAGE_U16] = 8, [KILN_IMAGE_F32] = 16};
    return (size_t)image->width * image->height * pixel_bytes[image->type];
}

/* Decodes a PNG, JPEG, WebP, TIFF, BMP or EXR file, or returns NULL: KILN_IO when it cannot be
 * read, KILN_INVALID_INPUT with what was found and what is allowed
 * when it is not a regular file, not such an image, broken or truncated, or beyond the limits above
 * (found before memory is taken for its pixels), KILN_OVER_LIMIT beyond the loader's budget,
 * KILN_DEVICE_FAILED when memory is short or the decoder is not installed. Floats are finite. The
 * caller destroys it. */
struct kiln_asset_image *kiln_asset_image_load(struct kiln_loader *loader, const char *path,
                                               struct kiln_error *error);

/* The same for one layer of a file: EXR files have several, of which "beauty" is the picture; other
 * formats have that one alone. KILN_INVALID_INPUT, too, when there is no such layer. Floats are as
 * they are in the file. */
struct kiln_asset_image *kiln_asset_image_load_layer(struct kiln_loader *loader, const char *path,
                                                     const char *layer, struct kiln_error *error);

/* As the first, from bytes in memory; name stands for the file in messages. */
struct kiln_asset_image *kiln_asset_image_parse(const void *bytes, size_t size, const char *name,
                                                struct kiln_error *error);
void kiln_asset_image_destroy(struct kiln_asset_image **image);

/* Whether load would succeed, and the size, width and height: decodes the whole image, unless the
 * loader has done so before. */
bool kiln_asset_image_check(struct kiln_loader *loader, const char *path, struct kiln_error *error);
bool kiln_asset_image_size(struct kiln_loader *loader, const char *path, uint32_t size[2],
                           struct kiln_error *error);

#endif
