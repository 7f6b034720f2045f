/* This file makes a picture with mip levels on the host, in half floats. Each level is filtered
 * linearly from the finer one, like the levels of GL drivers: a texel is the mean of four where the
 * size is even, and of a slightly wider area where it is odd. */
#include "asset/image/pyramid.h"

#include <stdlib.h>
#include <string.h>

#include "asset/image/image.h"
#include "asset/image/linear.h"
#include "base/error.h"
#include "base/pages.h"
#include "shared/exact.h"

/* Converts 0 to 65504 to a half float, rounded to the nearest. Numbers below the least normal half
 * float are rounded by adding a number whose last bit is that of a subnormal half float. */
static uint16_t to_half(float x)
{
    uint bits = FLOAT_BITS(x);
    if (bits < 0x38800000u) /* below 2^-14 half floats are subnormal, with even steps */
        return (uint16_t)(FLOAT_BITS(x + 0.5f) - 0x3f000000u);
    bits += 0xfffu + (bits >> 13 & 1u);
    return (uint16_t)((bits - 0x38000000u) >> 13);
}

static float from_half(uint16_t half)
{
    return BITS_FLOAT((uint)half << 13) * 0x1p112f;
}

/* Computes the sizes of the levels; returns the number of their texels. */
static size_t lay_out(struct kiln_pyramid *p)
{
    size_t texels = 0;
    uint32_t width = p->width, height = p->height;
    for (p->levels = 0; p->levels < KILN_PYRAMID_LEVELS;) {
        uint32_t level = p->levels++;
        p->widths[level] = width;
        p->heights[level] = height;
        p->first[level] = (uint32_t)texels; /* images have at most 2^28 pixels */
        texels += (size_t)width * height;
        if (width == 1 && height == 1)
            break;
        width = width > 1 ? width / 2 : 1;
        height = height > 1 ? height / 2 : 1;
    }
    return texels;
}

static bool fill_finest(struct kiln_pyramid *p, const struct kiln_asset_image *image)
{
    float *row = malloc((size_t)p->width * 3 * sizeof *row);
    for (uint32_t y = 0; row && y < p->height; y++) {
        kiln_linear_row(image, y, row);
        uint16_t(*to)[4] = p->texels + (size_t)y * p->width;
        for (uint32_t x = 0; x < p->width; x++) {
            for (uint32_t c = 0; c < 3; c++)
                to[x][c] = to_half(row[3 * x + c]);
            to[x][3] = 0;
        }
    }
    free(row);
    return row != NULL;
}

/* The two rows or columns of the finer level around a texel, and the texel's place between them. */
struct between {
    uint32_t a, b;
    float part;
};

static struct between look_up(uint32_t at, uint32_t size, uint32_t finer, bool repeats)
{
    float x = ((float)at + 0.5f) * ((float)finer / (float)size) - 0.5f;
    float before = floorf(x);
    int64_t a = (int64_t)before, b = a + 1;
    if (a < 0)
        a = repeats ? finer - 1 : 0;
    if (b >= finer)
        b = repeats ? 0 : finer - 1;
    return (struct between){(uint32_t)a, (uint32_t)b, x - before};
}

static void shrink(struct kiln_pyramid *p, uint32_t level, bool repeats_y)
{
    uint32_t width = p->widths[level], height = p->heights[level], finer = p->widths[level - 1];
    const uint16_t(*from)[4] = (const uint16_t(*)[4])p->texels + p->first[level - 1];
    uint16_t(*to)[4] = p->texels + p->first[level];
    for (uint32_t y = 0; y < height; y++) {
        struct between row = look_up(y, height, p->heights[level - 1], repeats_y);
        const uint16_t(*upper)[4] = from + (size_t)row.a * finer;
        const uint16_t(*lower)[4] = from + (size_t)row.b * finer;
        for (uint32_t x = 0; x < width; x++, to++) {
            struct between column = look_up(x, width, finer, true);
            for (int c = 0; c < 4; c++) {
                float a = from_half(upper[column.a][c]), b = from_half(upper[column.b][c]);
                float d = from_half(lower[column.a][c]), e = from_half(lower[column.b][c]);
                a += (b - a) * column.part;
                d += (e - d) * column.part;
                (*to)[c] = to_half(a + (d - a) * row.part);
            }
        }
    }
}

struct kiln_pyramid *kiln_pyramid_create(uint32_t width, uint32_t height)
{
    struct kiln_pyramid *pyramid = calloc(1, sizeof *pyramid);
    if (!pyramid)
        return NULL;
    pyramid->width = width;
    pyramid->height = height;
    const size_t bytes = lay_out(pyramid) * sizeof *pyramid->texels;
    pyramid->texels = kiln_alloc_pages(bytes);
    if (pyramid->texels)
        memset(pyramid->texels, 0, bytes);
    else
        kiln_pyramid_destroy(&pyramid);
    return pyramid;
}

uint64_t kiln_pyramid_bytes(uint32_t width, uint32_t height)
{
    struct kiln_pyramid pyramid = {.width = width, .height = height};
    return lay_out(&pyramid) * sizeof *pyramid.texels;
}

size_t kiln_pyramid_texels(const struct kiln_pyramid *pyramid)
{
    const uint32_t last = pyramid->levels - 1;
    return pyramid->first[last] + (size_t)pyramid->widths[last] * pyramid->heights[last];
}

void kiln_pyramid_set(struct kiln_pyramid *pyramid, const float (*texels)[4])
{
    const size_t count = kiln_pyramid_texels(pyramid);
    for (size_t i = 0; i < count; i++) {
        for (int c = 0; c < 4; c++)
            pyramid->texels[i][c] = to_half(texels[i][c]);
    }
}

struct kiln_pyramid *kiln_pyramid_load(struct kiln_loader *loader, const char *path, bool repeats_y,
                                       struct kiln_error *error)
{
    struct kiln_asset_image *image = kiln_asset_image_load(loader, path, error);
    if (!image)
        return NULL;
    struct kiln_pyramid *pyramid = kiln_pyramid_create(image->width, image->height);
    if (!pyramid || !fill_finest(pyramid, image)) {
        kiln_error_no_memory(error, "%s", path);
        kiln_pyramid_destroy(&pyramid);
    }
    for (uint32_t level = 1; pyramid && level < pyramid->levels; level++)
        shrink(pyramid, level, repeats_y);
    kiln_asset_image_destroy(&image);
    return pyramid;
}

void kiln_pyramid_destroy(struct kiln_pyramid **pyramid)
{
    if (!*pyramid)
        return;
    free((*pyramid)->texels);
    free(*pyramid);
    *pyramid = NULL;
}
