/* This file turns samples of TIFF files into pixels. All arithmetic is kiln's own, and not that of
 * libtiff, which uses floats and powers of libm for CIELAB and YCbCr. */
#include <string.h>

#include "tiff.h"
#include "values.h"

enum kiln_image_type decode_tiff_type(const struct tiff_samples *samples)
{
    if (samples->floats)
        return KILN_IMAGE_F32;
    const bool deep = samples->bits > 8 && samples->color != TIFF_PALETTE;
    return deep ? KILN_IMAGE_U16 : KILN_IMAGE_U8;
}

/* ---- storing --------------------------------------------------------------------------------- */

/* Returns a sample of 1 to 16 bits. Samples of 16 bits are in the host's order; others lie one
 * after the other, the highest bit first. */
static uint32_t integer_at(const uint8_t *row, uint32_t bits, size_t index)
{
    if (bits == 8)
        return row[index];
    if (bits == 16) {
        uint16_t word;
        memcpy(&word, row + 2 * index, sizeof word);
        return word;
    }
    uint32_t value = 0;
    for (size_t bit = index * bits; bit < (index + 1) * bits; bit++)
        value = value << 1 | (uint32_t)(row[bit / 8] >> (7 - bit % 8) & 1);
    return value;
}

static float float_at(const uint8_t *row, uint32_t bits, size_t index)
{
    if (bits == 16)
        return decode_half(integer_at(row, 16, index));
    if (bits == 32) {
        float value;
        memcpy(&value, row + sizeof value * index, sizeof value);
        return value;
    }
    double value;
    memcpy(&value, row + sizeof value * index, sizeof value);
    return (float)value;
}

static void store_floats(const struct tiff_samples *samples, const struct tiff_run *run,
                         struct kiln_asset_image *image)
{
    float *out = (float *)image->pixels + 4 * run->pixel + run->slot;
    for (uint32_t x = 0; x < run->count; x++)
        out[4 * (size_t)x] =
            float_at(run->row, samples->bits, (size_t)x * run->stride + run->first);
}

void decode_tiff_store(const struct tiff_samples *samples, const struct tiff_run *run,
                       struct kiln_asset_image *image, void *ink_alpha)
{
    if (samples->floats) {
        store_floats(samples, run, image);
        return;
    }
    const bool apart = run->slot == TIFF_INK_ALPHA;
    const size_t step = apart ? 1 : 4, begin = apart ? run->pixel : 4 * run->pixel + run->slot;
    const bool is_index = samples->color == TIFF_PALETTE && run->slot == 0;
    const uint32_t bits = samples->bits, largest = (1u << bits) - 1;
    const uint32_t full = decode_full(image);
    uint8_t *bytes = (uint8_t *)(apart ? ink_alpha : image->pixels);
    uint16_t *words = apart ? ink_alpha : image->pixels;
    for (uint32_t x = 0; x < run->count; x++) {
        uint32_t value = integer_at(run->row, bits, (size_t)x * run->stride + run->first);
        const size_t at = begin + step * x;
        if (!is_index && largest != full)
            value = (value * full + largest / 2) / largest;
        if (image->type == KILN_IMAGE_U16)
            words[at] = (uint16_t)value;
        else
            bytes[at] = (uint8_t)value;
    }
}

/* ---- meaning --------------------------------------------------------------------------------- */

static size_t values_of(const struct kiln_asset_image *image)
{
    return 4 * (size_t)image->width * image->height;
}

static void make_opaque(struct kiln_asset_image *image)
{
    const size_t count = values_of(image);
    for (size_t i = 3; i < count; i += 4) {
        if (image->type == KILN_IMAGE_F32)
            ((float *)image->pixels)[i] = 1.0f;
        else
            decode_set_value(image, i, decode_full(image));
    }
}

static void spread_grey(struct kiln_asset_image *image, bool inverted)
{
    const size_t count = values_of(image);
    float *floats = image->pixels;
    for (size_t i = 0; i < count; i += 4) {
        if (image->type == KILN_IMAGE_F32) {
            floats[i + 1] = floats[i + 2] = floats[i];
            continue;
        }
        const uint32_t stored = decode_value(image, i);
        const uint32_t grey = inverted ? decode_full(image) - stored : stored;
        for (size_t c = 0; c < 3; c++)
            decode_set_value(image, i + c, grey);
    }
}

static void invert(struct kiln_asset_image *image)
{
    const size_t count = values_of(image);
    for (size_t i = 0; i < count; i++)
        decode_set_value(image, i, decode_full(image) - decode_value(image, i));
}

/* Turns indices into colours of 8 bits. Numbers of a map have 16 bits: level * 257 by the
 * specification, level * 256 from some writers, and the level alone from old ones. */
static void look_up(const struct tiff_samples *samples, struct kiln_asset_image *image)
{
    uint8_t levels[3][256];
    uint32_t any = 0;
    const uint32_t entries = 1u << samples->bits;
    for (uint32_t c = 0; c < 3; c++) {
        for (uint32_t i = 0; i < entries; i++)
            any |= samples->map[c][i];
    }
    for (uint32_t c = 0; c < 3; c++) {
        for (uint32_t i = 0; i < entries; i++) {
            const uint32_t entry = samples->map[c][i];
            levels[c][i] = (uint8_t)(any < 256          ? entry
                                     : (any & 255) == 0 ? entry >> 8
                                                        : (entry + 128) / 257);
        }
    }
    const size_t count = values_of(image);
    uint8_t *bytes = image->pixels;
    for (size_t i = 0; i < count; i += 4) {
        const uint8_t index = bytes[i];
        for (uint32_t c = 0; c < 3; c++)
            bytes[i + c] = levels[c][index];
    }
}

/* Makes signed numbers of a and b unsigned, and converts CIELAB to sRGB. */
static bool show_lab(const struct tiff_samples *samples, struct kiln_asset_image *image)
{
    const bool deep = image->type == KILN_IMAGE_U16, icc = samples->color == TIFF_ICC_LAB;
    const size_t count = values_of(image);
    for (size_t i = 0; !icc && i < count; i += 4) {
        for (size_t c = 1; c < 3; c++)
            decode_set_value(image, i + c, decode_value(image, i + c) ^ (deep ? 0x8000u : 0x80u));
    }
    const struct kiln_lab lab = {.white = {samples->white[0], samples->white[1]},
                                 .brightest = !deep ? 255.0
                                              : icc ? 65280.0
                                                    : 65535.0};
    return kiln_lab_convert(&lab, image);
}

static uint8_t to_level(double x)
{
    return (uint8_t)(x > 0.0 ? (x < 255.0 ? x + 0.5 : 255.0) : 0.0);
}

/* Converts YCbCr to RGB (TIFF 6.0, section 21). */
static void show_ycbcr(const struct tiff_samples *samples, struct kiln_asset_image *image)
{
    const size_t count = values_of(image);
    const double *luma = samples->luma, *range = samples->range;
    uint8_t *bytes = image->pixels;
    const double scales[3] = {255.0 / (range[1] - range[0]), 127.0 / (range[3] - range[2]),
                              127.0 / (range[5] - range[4])};
    for (size_t i = 0; i < count; i += 4) {
        const double y = ((double)bytes[i] - range[0]) * scales[0];
        const double cb = ((double)bytes[i + 1] - range[2]) * scales[1];
        const double cr = ((double)bytes[i + 2] - range[4]) * scales[2];
        const double red = y + cr * (2.0 - 2.0 * luma[0]);
        const double blue = y + cb * (2.0 - 2.0 * luma[2]);
        bytes[i] = to_level(red);
        bytes[i + 1] = to_level((y - luma[2] * blue - luma[0] * red) / luma[1]);
        bytes[i + 2] = to_level(blue);
    }
}

bool decode_tiff_finish(const struct tiff_samples *samples, struct kiln_asset_image *image)
{
    if (!samples->alpha && samples->color != TIFF_INK)
        make_opaque(image);
    switch (samples->color) {
    case TIFF_GREY:
        spread_grey(image, false);
        break;
    case TIFF_GREY_OF_WHITE:
        spread_grey(image, true);
        break;
    case TIFF_PALETTE:
        look_up(samples, image);
        break;
    case TIFF_RGB:
        break;
    case TIFF_INK:
        invert(image);
        break;
    case TIFF_LAB:
    case TIFF_ICC_LAB:
        return show_lab(samples, image);
    case TIFF_YCBCR:
        show_ycbcr(samples, image);
        break;
    }
    return true;
}
