/* This file makes cells out of the pixels of an image. A pixel that counts twice as much as another
 * gets twice as many particles, so that the edges of a logo, which are half transparent, stay
 * smooth, and a photograph becomes a stipple drawing. */
#include "scene/source_image.h"

#include <stdlib.h>

#include "scene/source_alias.h"
#include "shared/exact.h"
#include "shared/source.h"

/* The largest number of an integer format; 1 of floats. */
static float brightest_of(const struct kiln_asset_image *image)
{
    return image->type == KILN_IMAGE_U8 ? 255.0f : image->type == KILN_IMAGE_U16 ? 65535.0f : 1.0f;
}

static float number_at(const struct kiln_asset_image *image, size_t at)
{
    if (image->type == KILN_IMAGE_F32)
        return ((const float *)image->pixels)[at];
    if (image->type == KILN_IMAGE_U16)
        return (float)((const uint16_t *)image->pixels)[at];
    return (float)((const uint8_t *)image->pixels)[at];
}

static bool is_opaque(const struct kiln_asset_image *image)
{
    const size_t pixels = (size_t)image->width * image->height;
    const float brightest = brightest_of(image);
    bool opaque = true;
    for (size_t i = 0; opaque && i < pixels; i++)
        opaque = number_at(image, 4 * i + 3) >= brightest;
    return opaque;
}

/* Returns how much a pixel counts, 0 to 1: its alpha, or the luma of Rec. 709 of its numbers as
 * they are stored. */
static double count_of(const struct kiln_asset_image *image, bool by_alpha, size_t pixel)
{
    const double brightest = (double)brightest_of(image);
    double sum = (double)number_at(image, 4 * pixel + 3);
    if (!by_alpha)
        sum = 0.2126 * (double)number_at(image, 4 * pixel) +
              0.7152 * (double)number_at(image, 4 * pixel + 1) +
              0.0722 * (double)number_at(image, 4 * pixel + 2);
    const double part = sum / brightest;
    return part > 0 ? (part < 1 ? part : 1) : 0;
}

struct kiln_pixel_counts kiln_source_count_pixels(const struct kiln_asset_image *image,
                                                  double threshold)
{
    const size_t pixels = (size_t)image->width * image->height;
    struct kiln_pixel_counts counts = {.by_alpha = !is_opaque(image)};
    for (size_t i = 0; i < pixels; i++) {
        const double one = count_of(image, counts.by_alpha, i);
        counts.above += one > threshold;
        counts.most = one > counts.most ? one : counts.most;
    }
    return counts;
}

static void write_color(const struct kiln_asset_image *image, struct kiln_source *source,
                        uint32_t cell, const struct kiln_alias *alias, uint32_t x, uint32_t y)
{
    float rgb[3];
    kiln_source_pixel(image, x, y, rgb);
    source->texels[cell] = UINT4(FLOAT_BITS(alias->share), alias->other, cell, 1);
    kiln_source_set_color(source, cell, kiln_source_pack(rgb));
}

bool kiln_source_fill_image(struct kiln_arena *arena, const struct kiln_asset_image *image,
                            double threshold, double width, bool colored, uint32_t count,
                            struct kiln_source *source)
{
    const bool by_alpha = !is_opaque(image);
    const double edge = width / image->width;
    double *weights = malloc(count * sizeof *weights);
    struct kiln_alias *table = malloc(count * sizeof *table);
    uint32_t *pixels = malloc(count * sizeof *pixels), next = 0;
    source->making = (uint64_t)count * (KILN_ALIAS_BYTES + sizeof *pixels);
    source->cells = source->word_count = count;
    source->words = kiln_arena_alloc(arena, count, sizeof *source->words);
    bool ok = weights && table && pixels && source->words &&
              (!colored || kiln_source_make_texels(arena, source, count));
    for (uint32_t i = 0; ok && next < count; i++) {
        const double counts = count_of(image, by_alpha, i);
        if (!(counts > threshold))
            continue;
        weights[next] = counts;
        pixels[next++] = i;
    }
    ok = ok && kiln_alias_fill(weights, count, table);
    for (uint32_t i = 0; ok && i < count; i++) {
        const uint32_t x = pixels[i] % image->width, y = pixels[i] / image->width;
        const double left = (x - 0.5 * image->width) * edge;
        const double lower = (0.5 * image->height - y - 1) * edge;
        source->words[i] = FLOAT4(exact_canon((float)left), exact_canon((float)lower),
                                  table[i].share, (float)table[i].other);
        if (colored)
            write_color(image, source, i, &table[i], x, y);
    }
    free(weights);
    free(table);
    free(pixels);
    return ok;
}
