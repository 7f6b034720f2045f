/* This file finds out what the samples of a page of a TIFF file are, by its tags, and refuses what
 * kiln cannot show, by name. */
#include <stdio.h>

#include "base/error.h"
#include "tiff_file.h"

enum { MOST_SAMPLES = 64 }; /* of a pixel */

uint16_t decode_tiff_number(const struct tiff_reading *reading, uint32_t tag, uint16_t otherwise)
{
    uint16_t number = otherwise;
    return reading->tiff->TIFFGetFieldDefaulted(reading->file, tag, &number) ? number : otherwise;
}

static bool check_compression(struct tiff_reading *reading)
{
    static const struct {
        uint16_t number;
        const char *name;
    } names[] = {
        {COMPRESSION_CCITTRLE, "CCITT RLE"},
        {COMPRESSION_CCITTFAX3, "CCITT Group 3"},
        {COMPRESSION_CCITTFAX4, "CCITT Group 4"},
        {COMPRESSION_LZW, "LZW"},
        {COMPRESSION_OJPEG, "JPEG in the style of TIFF 6.0"},
        {COMPRESSION_JPEG, "JPEG"},
        {COMPRESSION_T85, "JBIG (T.85)"},
        {COMPRESSION_T43, "JBIG (T.43)"},
        {COMPRESSION_NEXT, "NeXT"},
        {COMPRESSION_THUNDERSCAN, "ThunderScan"},
        {COMPRESSION_PIXARLOG, "PixarLog"},
        {COMPRESSION_DEFLATE, "Deflate"},
        {COMPRESSION_ADOBE_DEFLATE, "Deflate"},
        {COMPRESSION_JBIG, "JBIG"},
        {COMPRESSION_SGILOG, "LogLuv"},
        {COMPRESSION_SGILOG24, "LogLuv of 24 bits"},
        {COMPRESSION_JP2000, "JPEG 2000"},
        {33003, "JPEG 2000"}, /* Aperio's, with YCbCr */
        {33005, "JPEG 2000"}, /* Aperio's, with RGB */
        {34892, "lossy JPEG of DNG"},
        {COMPRESSION_LERC, "LERC"},
        {COMPRESSION_LZMA, "LZMA"},
        {COMPRESSION_ZSTD, "ZSTD"},
        {COMPRESSION_WEBP, "WebP"},
        {COMPRESSION_JXL, "JPEG XL"},
        {52546, "JPEG XL"}, /* of DNG 1.7 */
    };
    const uint16_t number = reading->compression;
    char name[48], what[80];
    if (number != COMPRESSION_OJPEG && reading->tiff->TIFFIsCODECConfigured(number))
        return true;
    snprintf(name, sizeof name, "number %u", number);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (names[i].number == number)
            snprintf(name, sizeof name, "%s", names[i].name);
    }
    snprintf(what, sizeof what, "whose compression is %s", name);
    return decode_tiff_refuse(reading, what);
}

static bool check_numbers(struct tiff_reading *reading)
{
    struct tiff_samples *samples = &reading->samples;
    const uint16_t format = decode_tiff_number(reading, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    char what[80];
    samples->bits = decode_tiff_number(reading, TIFFTAG_BITSPERSAMPLE, 1);
    samples->planar = decode_tiff_number(reading, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) ==
                      PLANARCONFIG_SEPARATE;
    samples->floats = format == SAMPLEFORMAT_IEEEFP;
    const bool lab = samples->color == TIFF_LAB;
    const uint32_t bits = samples->bits;
    if (format == SAMPLEFORMAT_COMPLEXIEEEFP || format == SAMPLEFORMAT_COMPLEXINT)
        return decode_tiff_refuse(reading, "of complex numbers");
    if (format == SAMPLEFORMAT_INT && !lab)
        return decode_tiff_refuse(reading, "of signed integers");
    if (samples->samples < 1 || samples->samples > MOST_SAMPLES) {
        snprintf(what, sizeof what, "of %u samples a pixel", samples->samples);
        return decode_tiff_refuse(reading, what);
    }
    if (samples->floats ? bits == 16 || bits == 32 || bits == 64 : bits >= 1 && bits <= 16)
        return true;
    snprintf(what, sizeof what, "of %s of %u bits", samples->floats ? "floats" : "integers", bits);
    return decode_tiff_refuse(reading, what);
}

/* Says of which kind the colours are, and checks that there are enough samples. */
static bool check_color(struct tiff_reading *reading)
{
    static const struct {
        uint16_t number;
        const char *name;
        enum tiff_color color;
        uint32_t colors; /* 0: cannot be read */
    } kinds[] = {
        {PHOTOMETRIC_MINISBLACK, "grey", TIFF_GREY, 1},
        {PHOTOMETRIC_MINISWHITE, "grey where 0 is white", TIFF_GREY_OF_WHITE, 1},
        {PHOTOMETRIC_PALETTE, "a palette", TIFF_PALETTE, 1},
        {PHOTOMETRIC_RGB, "RGB", TIFF_RGB, 3},
        {PHOTOMETRIC_SEPARATED, "ink", TIFF_INK, 4},
        {PHOTOMETRIC_CIELAB, "CIELAB", TIFF_LAB, 3},
        {PHOTOMETRIC_ICCLAB, "CIELAB", TIFF_ICC_LAB, 3},
        {PHOTOMETRIC_YCBCR, "YCbCr", TIFF_YCBCR, 3},
        {PHOTOMETRIC_MASK, "a mask", TIFF_GREY, 0},
        {PHOTOMETRIC_ITULAB, "CIELAB of the ITU", TIFF_LAB, 0},
        {PHOTOMETRIC_CFA, "a sensor behind a mosaic of filters", TIFF_GREY, 0},
        {PHOTOMETRIC_LOGL, "LogL", TIFF_GREY, 0},
        {PHOTOMETRIC_LOGLUV, "LogLuv", TIFF_GREY, 0},
        {34892, "a camera's own primaries (DNG)", TIFF_RGB, 0},
    };
    struct tiff_samples *samples = &reading->samples;
    uint16_t number = 0;
    char what[80];
    if (!reading->tiff->TIFFGetField(reading->file, TIFFTAG_PHOTOMETRIC, &number))
        return decode_tiff_refuse(reading, "that does not say what its colours are (tag 262)");
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        if (kinds[i].number != number)
            continue;
        samples->color = kinds[i].color;
        samples->colors = kinds[i].colors;
        snprintf(what, sizeof what, "of %s with %u samples a pixel", kinds[i].name,
                 samples->samples);
        if (kinds[i].colors > 0 && samples->samples >= kinds[i].colors)
            return true;
        if (kinds[i].colors == 0)
            snprintf(what, sizeof what, "whose colours are of %s", kinds[i].name);
        return decode_tiff_refuse(reading, what);
    }
    snprintf(what, sizeof what, "whose colours are of kind %u (tag 262)", number);
    return decode_tiff_refuse(reading, what);
}

/* Refuses combinations of colours and numbers that have no meaning, or none that is known. */
static bool check_both(struct tiff_reading *reading)
{
    const struct tiff_samples *samples = &reading->samples;
    const uint32_t bits = samples->bits;
    char what[80];
    const bool plain = samples->color == TIFF_GREY || samples->color == TIFF_RGB;
    if (samples->floats && !plain)
        return decode_tiff_refuse(reading,
                                  "of floats that are neither grey, with 0 for black, nor RGB");
    const bool lab = samples->color == TIFF_LAB || samples->color == TIFF_ICC_LAB;
    const bool fits = lab                              ? bits == 8 || bits == 16
                      : samples->color == TIFF_YCBCR   ? bits == 8
                      : samples->color == TIFF_PALETTE ? bits <= 8
                                                       : true;
    if (reading->compression == COMPRESSION_JPEG && bits != 8) {
        snprintf(what, sizeof what, "of JPEG with %u bits a sample", bits);
        return decode_tiff_refuse(reading, what);
    }
    snprintf(what, sizeof what, "of %u bits a sample and such colours", bits);
    if (!fits)
        return decode_tiff_refuse(reading, what);
    if (samples->color != TIFF_INK ||
        decode_tiff_number(reading, TIFFTAG_INKSET, INKSET_CMYK) == INKSET_CMYK)
        return true;
    return decode_tiff_refuse(reading, "of inks other than cyan, magenta, yellow and black");
}

/* Finds the first sample that the file names as alpha. Others have no meaning that kiln knows. */
static bool find_alpha(struct tiff_reading *reading)
{
    struct tiff_samples *samples = &reading->samples;
    uint16_t count = 0, *kinds = NULL;
    if (!reading->tiff->TIFFGetFieldDefaulted(reading->file, TIFFTAG_EXTRASAMPLES, &count, &kinds))
        return true;
    for (uint32_t i = 0; kinds && i < count && samples->colors + i < samples->samples; i++) {
        if (kinds[i] == EXTRASAMPLE_ASSOCALPHA || kinds[i] == EXTRASAMPLE_UNASSALPHA) {
            samples->alpha = samples->colors + i;
            samples->associated = kinds[i] == EXTRASAMPLE_ASSOCALPHA;
            break;
        }
    }
    return !samples->associated || samples->color == TIFF_GREY || samples->color == TIFF_RGB ||
           decode_tiff_refuse(reading, "of colours multiplied by alpha that are neither grey, with "
                                       "0 for black, nor RGB");
}

static bool find_palette(struct tiff_reading *reading)
{
    uint16_t *map[3] = {NULL};
    if (!reading->tiff->TIFFGetField(reading->file, TIFFTAG_COLORMAP, &map[0], &map[1], &map[2]) ||
        !map[0] || !map[1] || !map[2])
        return decode_tiff_refuse(reading, "whose palette is missing");
    for (int c = 0; c < 3; c++)
        reading->samples.map[c] = map[c];
    return true;
}

static void find_white(struct tiff_reading *reading)
{
    static const double d50[2] = KILN_WHITE_D50;
    const float *white = NULL;
    const bool has =
        reading->tiff->TIFFGetField(reading->file, TIFFTAG_WHITEPOINT, &white) && white;
    for (int i = 0; i < 2; i++)
        reading->samples.white[i] = has ? (double)white[i] : d50[i];
}

static bool find_ycbcr(struct tiff_reading *reading)
{
    struct tiff_samples *samples = &reading->samples;
    const float *luma = NULL, *range = NULL;
    uint16_t chroma[2] = {2, 2};
    if (!reading->tiff->TIFFGetFieldDefaulted(reading->file, TIFFTAG_YCBCRCOEFFICIENTS, &luma) ||
        !reading->tiff->TIFFGetFieldDefaulted(reading->file, TIFFTAG_REFERENCEBLACKWHITE, &range) ||
        !reading->tiff->TIFFGetFieldDefaulted(reading->file, TIFFTAG_YCBCRSUBSAMPLING, &chroma[0],
                                              &chroma[1]) ||
        !luma || !range)
        return decode_tiff_refuse_broken(reading);
    for (int i = 0; i < 2; i++) {
        if (chroma[i] != 1 && chroma[i] != 2 && chroma[i] != 4)
            return decode_tiff_refuse_broken(reading);
        samples->chroma[i] = chroma[i];
    }
    for (int i = 0; i < 3; i++)
        samples->luma[i] = (double)luma[i];
    for (int i = 0; i < 6; i++)
        samples->range[i] = (double)range[i];
    bool sound = samples->luma[1] > 1e-3;
    for (int i = 0; i < 3; i++)
        sound = sound && samples->luma[i] >= 0.0 && samples->luma[i] <= 1.0;
    for (int i = 0; i < 6; i += 2)
        sound = sound && samples->range[i + 1] - samples->range[i] >= 1.0 &&
                samples->range[i + 1] <= 65535.0 && samples->range[i] >= -65535.0;
    if (!sound)
        return decode_tiff_refuse(reading, "with such coefficients of YCbCr");
    const bool shared = samples->chroma[0] > 1 || samples->chroma[1] > 1;
    if (shared && (samples->planar || samples->samples != 3))
        return decode_tiff_refuse(reading, "of subsampled YCbCr in planes or with further samples");
    return true;
}

/* Lets libjpeg make RGB of the YCbCr of a JPEG stream. Must come before sizes are asked for. */
static bool choose_jpeg(struct tiff_reading *reading)
{
    struct tiff_samples *samples = &reading->samples;
    if (reading->compression != COMPRESSION_JPEG || samples->color != TIFF_YCBCR || samples->planar)
        return true;
    if (samples->samples != 3)
        return decode_tiff_refuse(reading, "of YCbCr by JPEG with further samples");
    samples->color = TIFF_RGB;
    return reading->tiff->TIFFSetField(reading->file, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB) ||
           decode_tiff_refuse_broken(reading);
}

bool decode_tiff_describe(struct tiff_reading *reading)
{
    struct tiff_samples *samples = &reading->samples;
    reading->compression = decode_tiff_number(reading, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    samples->samples = decode_tiff_number(reading, TIFFTAG_SAMPLESPERPIXEL, 1);
    samples->chroma[0] = samples->chroma[1] = 1;
    if (!reading->tiff->TIFFGetField(reading->file, TIFFTAG_IMAGEWIDTH, &reading->width) ||
        !reading->tiff->TIFFGetField(reading->file, TIFFTAG_IMAGELENGTH, &reading->height))
        return decode_tiff_refuse_broken(reading);
    if (!decode_allows_size(reading->picture, "TIFF", reading->width, reading->height) ||
        !check_color(reading) || !check_numbers(reading) || !check_both(reading) ||
        !check_compression(reading) || !choose_jpeg(reading))
        return false;
    if (!find_alpha(reading))
        return false;
    if (samples->color == TIFF_PALETTE)
        return find_palette(reading);
    if (samples->color == TIFF_YCBCR)
        return find_ycbcr(reading);
    find_white(reading);
    return true;
}
