/* Declares what the reader of TIFF files (tiff.c) and its conversion of samples (tiff_samples.c)
 * share. The facts about the format are those of "TIFF, Revision 6.0" (Adobe, 1992). */
#ifndef KILN_DECODE_TIFF_H
#define KILN_DECODE_TIFF_H

#include "decode.h"

enum tiff_color {
    TIFF_GREY,
    TIFF_GREY_OF_WHITE, /* 0 is white */
    TIFF_PALETTE,
    TIFF_RGB,
    TIFF_INK,
    TIFF_LAB,     /* CIELAB, with signed a and b */
    TIFF_ICC_LAB, /* CIELAB as in ICC profiles, with an offset to a and b */
    TIFF_YCBCR,
};

/* Describes the samples of a page, and what they mean. */
struct tiff_samples {
    enum tiff_color color;
    uint32_t colors;  /* samples of a pixel that are colour: 1, 3 or 4 */
    uint32_t samples; /* of a pixel */
    uint32_t alpha;   /* the index of the sample that is alpha; 0: there is none */
    bool associated;  /* colour is already multiplied by alpha */
    uint32_t bits;    /* of a sample: 1 to 16, or 16, 32 or 64 of a float */
    bool floats, planar;
    uint32_t chroma[2];     /* how many pixels share a sample of Cb and Cr, across and down */
    const uint16_t *map[3]; /* of a palette: 2^bits numbers each */
    double white[2];        /* chromaticity of CIELAB's white */
    double luma[3];         /* of YCbCr: the parts of red, green and blue in Y */
    double range[6];        /* of YCbCr: the numbers for black and white of Y, Cb and Cr */
};

/* A part of a row whose numbers are to be stored. */
struct tiff_run {
    const uint8_t *row;     /* as libtiff decodes it: numbers of 16 bits or more are the host's */
    uint32_t stride, first; /* samples from pixel to pixel, and the place of the first */
    uint32_t count;         /* pixels */
    size_t pixel;           /* the first pixel of the image */
    uint32_t slot;          /* 0 to 3: of the image's pixel; TIFF_INK_ALPHA */
};

enum { TIFF_INK_ALPHA = 4 };

/* Returns the type of the image's numbers. */
enum kiln_image_type decode_tiff_type(const struct tiff_samples *samples);

/* Stores one sample of each pixel of a run in the image, or in ink_alpha, which has one number of
 * the image's type for each pixel. */
void decode_tiff_store(const struct tiff_samples *samples, const struct tiff_run *run,
                       struct kiln_asset_image *image, void *ink_alpha);

/* Turns the stored samples into grey or RGB with alpha, or into ink as decode_show expects it.
 * False: the white of CIELAB is none. */
bool decode_tiff_finish(const struct tiff_samples *samples, struct kiln_asset_image *image);

#endif
