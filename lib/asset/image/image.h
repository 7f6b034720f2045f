/* Declares pictures for textures and figures, and loads them from files by kiln-decode. A file's
 * first bytes tell its format, never its name. An image cannot make kiln or kiln-decode open
 * another file. A loader of NULL may open any file, and starts a process for each. */
#ifndef KILN_ASSET_IMAGE_IMAGE_H
#define KILN_ASSET_IMAGE_IMAGE_H

#include "asset/loader/loader.h"

/* The formats of pictures, for messages. */
#define KILN_IMAGE_FORMATS "PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR"

enum {
    KILN_MAX_IMAGE_EDGE = 16384,      /* pixels a side */
    KILN_MAX_IMAGE_PIXELS = 1 << 26,  /* width * height */
    KILN_MAX_IMAGE_PAGES = 65536,     /* of a file */
    KILN_MAX_IMAGE_LAYERS = 1024,     /* of a file */
    KILN_MAX_IMAGE_BYTES = 256 << 20, /* bytes of the file */
};

enum kiln_image_type {
    KILN_IMAGE_U8,  /* uint8_t, 0..255 */
    KILN_IMAGE_U16, /* uint16_t, 0..65535, host byte order */
    KILN_IMAGE_F32, /* float */
    KILN_IMAGE_U32, /* uint32_t: whole numbers of a layer of data (layers_in.h) */
};

/* Holds RGBA pixels of the picture as it is shown: upright, and of sRGB's primaries
 * (docs/pictures.md); rows from the top, tightly packed. Sources without alpha get the full
 * value. */
struct kiln_asset_image {
    uint32_t width, height;
    /* channels of the source: 1 grey, 2 grey and alpha, 3 colour, 4 colour and alpha */
    uint32_t channels;
    enum kiln_image_type type;
    bool srgb; /* encoded with sRGB's transfer function; else linear */
    /* Colour is already multiplied by alpha: light in an EXR, encoded values where srgb is set
     * (TIFF). Colour beyond alpha, also where alpha is 0, is light without cover. */
    bool premultiplied;
    uint32_t pages; /* pages of the file, of which this is one; 1 for files without pages */
    void *pixels;
};

/* Returns the bytes of all pixels, of which each has four values. */
static inline size_t kiln_asset_image_bytes(const struct kiln_asset_image *image)
{
    static const size_t pixel_bytes[] = {
        [KILN_IMAGE_U8] = 4, [KILN_IMAGE_U16] = 8, [KILN_IMAGE_F32] = 16, [KILN_IMAGE_U32] = 16};
    return (size_t)image->width * image->height * pixel_bytes[image->type];
}

/* Decodes a PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR file. Floats are finite. The caller
 * destroys the image. NULL: KILN_IO when the file cannot be read; KILN_INVALID_INPUT, with what was
 * found and what is allowed, when it is no regular file, no such image, broken or truncated, or
 * beyond the limits above (which are checked before memory is taken for its pixels);
 * KILN_OVER_LIMIT beyond the loader's budget; KILN_DEVICE_FAILED when memory is short or the
 * decoder is not installed. */
struct kiln_asset_image *kiln_asset_image_load(struct kiln_loader *loader, const char *path,
                                               struct kiln_error *error);

/* Decodes a file whose numbers are not colours, such as heights or motion: they are neither
 * converted nor turned. */
struct kiln_asset_image *kiln_asset_image_load_data(struct kiln_loader *loader, const char *path,
                                                    struct kiln_error *error);

/* Decodes a picture that shows all directions, by longitude and latitude. An EXR file that says
 * that it is a cube map is refused. */
struct kiln_asset_image *kiln_asset_image_load_sky(struct kiln_loader *loader, const char *path,
                                                   struct kiln_error *error);

/* Decodes a sheet of cells. A PNG file is a sheet also where it is an animation, without a warning
 * of its frames. */
struct kiln_asset_image *kiln_asset_image_load_sheet(struct kiln_loader *loader, const char *path,
                                                     struct kiln_error *error);

/* Decodes one layer of a file. EXR files have several layers, of which "beauty" is the picture;
 * other formats have only "beauty". KILN_INVALID_INPUT also when there is no such layer. Floats are
 * not made finite. */
struct kiln_asset_image *kiln_asset_image_load_layer(struct kiln_loader *loader, const char *path,
                                                     const char *layer, struct kiln_error *error);

/* Decodes a page of a file; the first is 0. Only TIFF files have more than one. KILN_INVALID_INPUT
 * also when there is no such page. */
struct kiln_asset_image *kiln_asset_image_load_page(struct kiln_loader *loader, const char *path,
                                                    uint32_t page, struct kiln_error *error);

/* Decodes an image as kiln_asset_image_load does, from bytes in memory; name stands for the file in
 * messages. */
struct kiln_asset_image *kiln_asset_image_parse(const void *bytes, size_t size, const char *name,
                                                struct kiln_error *error);
void kiln_asset_image_destroy(struct kiln_asset_image **image);

/* kiln_asset_image_check returns whether kiln_asset_image_load would succeed,
 * kiln_asset_sheet_check whether kiln_asset_image_load_sheet would; kiln_asset_sheet_size also
 * gives width and height. They decode the whole image, unless the loader knows its size from
 * before. */
bool kiln_asset_image_check(struct kiln_loader *loader, const char *path, struct kiln_error *error);
bool kiln_asset_sheet_check(struct kiln_loader *loader, const char *path, struct kiln_error *error);
bool kiln_asset_sheet_size(struct kiln_loader *loader, const char *path, uint32_t size[2],
                           struct kiln_error *error);

#endif
