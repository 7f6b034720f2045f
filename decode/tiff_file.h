/* Declares what the parts of the reader of TIFF files share (tiff.c, tiff_tags.c). */
#ifndef KILN_DECODE_TIFF_FILE_H
#define KILN_DECODE_TIFF_FILE_H

#include <tiffio.h>

#include "base/library.h"
#include "tiff.h"

#define TIFF_FUNCTIONS(F)                                                                          \
    F(TIFFSetErrorHandler)                                                                         \
    F(TIFFSetWarningHandler)                                                                       \
    F(TIFFOpenOptionsAlloc)                                                                        \
    F(TIFFOpenOptionsFree)                                                                         \
    F(TIFFOpenOptionsSetMaxSingleMemAlloc)                                                         \
    F(TIFFOpenOptionsSetErrorHandlerExtR)                                                          \
    F(TIFFOpenOptionsSetWarningHandlerExtR)                                                        \
    F(TIFFClientOpenExt)                                                                           \
    F(TIFFClose)                                                                                   \
    F(TIFFReadDirectory)                                                                           \
    F(TIFFLastDirectory)                                                                           \
    F(TIFFSetDirectory)                                                                            \
    F(TIFFGetField)                                                                                \
    F(TIFFGetFieldDefaulted)                                                                       \
    F(TIFFSetField)                                                                                \
    F(TIFFIsCODECConfigured)                                                                       \
    F(TIFFIsTiled)                                                                                 \
    F(TIFFNumberOfStrips)                                                                          \
    F(TIFFNumberOfTiles)                                                                           \
    F(TIFFVStripSize64)                                                                            \
    F(TIFFTileSize64)                                                                              \
    F(TIFFGetStrileByteCount)                                                                      \
    F(TIFFReadEncodedStrip)                                                                        \
    F(TIFFReadEncodedTile)

struct tiff_library {
    TIFF_FUNCTIONS(KILN_LIBRARY_POINTER)
};

struct tiff_reading {
    const struct tiff_library *tiff;
    struct decode_picture *picture;
    TIFF *file;
    uint64_t place;   /* of the next byte to read */
    bool in_pixels;   /* libtiff decodes pixels */
    bool guessed;     /* libtiff had to guess some */
    char detail[200]; /* libtiff's first message of an error, or "" */
    uint16_t compression;
    uint32_t width, height;
    struct tiff_samples samples;
    struct kiln_asset_image *image;
    void *ink_alpha; /* of ink with alpha, or NULL */
    uint8_t *buffer; /* a decoded strip or tile */
};

/* Refuses "a TIFF image WHAT". Returns false. */
bool decode_tiff_refuse(struct tiff_reading *reading, const char *what);

/* Refuses a broken file, with libtiff's message. Returns false. */
bool decode_tiff_refuse_broken(struct tiff_reading *reading);

/* Returns a tag's number, or its default, or `otherwise`. */
uint16_t decode_tiff_number(const struct tiff_reading *reading, uint32_t tag, uint16_t otherwise);

/* Reads what the current image of the file is, and refuses what kiln cannot show. */
bool decode_tiff_describe(struct tiff_reading *reading);

#endif
