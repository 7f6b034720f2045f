/* Compares numbers as they are: a depth of infinity is as good as any other. All types of numbers
 * are compared as doubles, which hold each of them exactly. */
#include "compare/values.h"

#include <math.h>
#include <stdlib.h>

#include "base/error.h"

static double number_at(const struct kiln_asset_image *image, size_t at)
{
    switch (image->type) {
    case KILN_IMAGE_U8:
        return ((const uint8_t *)image->pixels)[at];
    case KILN_IMAGE_U16:
        return ((const uint16_t *)image->pixels)[at];
    case KILN_IMAGE_U32:
        return ((const uint32_t *)image->pixels)[at];
    case KILN_IMAGE_F32:
        break;
    }
    return (double)((const float *)image->pixels)[at];
}

/* Returns whether pixels of an image with so many channels have channel c of RGBA. Grey is copied
 * to green and blue, which are not counted again. */
static bool has_channel(uint32_t channels, unsigned c)
{
    return c == 0 || (c == 3 ? channels == 2 || channels == 4 : channels >= 3);
}

static double difference_of(double a, double b)
{
    if (a == b || (isnan(a) && isnan(b)))
        return 0;
    return isfinite(a) && isfinite(b) ? fabs(a - b) : INFINITY;
}

/* Returns the largest difference of the channels of a pixel. *differing counts those that differ.
 */
static double compare_pixel(const struct kiln_asset_image *const images[2], size_t pixel,
                            uint64_t *differing)
{
    double largest = 0;
    for (unsigned c = 0; c < 4; c++) {
        if (!has_channel(images[0]->channels, c) || !has_channel(images[1]->channels, c))
            continue;
        const double found =
            difference_of(number_at(images[0], 4 * pixel + c), number_at(images[1], 4 * pixel + c));
        *differing += found > 0;
        largest = found > largest ? found : largest;
    }
    return largest;
}

void kiln_values_compare(const struct kiln_asset_image *reference,
                         const struct kiln_asset_image *test, const uint8_t *masked,
                         struct kiln_value_difference *difference)
{
    const struct kiln_asset_image *const images[2] = {reference, test};
    const size_t pixels = (size_t)reference->width * reference->height;
    *difference = (struct kiln_value_difference){0};
    for (size_t i = 0; i < pixels; i++) {
        if (masked && masked[i])
            continue;
        const double found = compare_pixel(images, i, &difference->differing);
        if (!(found > difference->largest))
            continue;
        difference->largest = found;
        difference->x = (uint32_t)(i % reference->width);
        difference->y = (uint32_t)(i / reference->width);
    }
}

/* ---- pictures -------------------------------------------------------------------------------- */

/* The finite numbers of two layers, which are shown from black to white. */
struct range {
    double least, most;
};

static void widen(struct range *range, const struct kiln_asset_image *image)
{
    const size_t numbers = (size_t)image->width * image->height * 4;
    for (size_t i = 0; i < numbers; i++) {
        const double number = i % 4 < 3 ? number_at(image, i) : INFINITY;
        if (!isfinite(number))
            continue;
        range->least = number < range->least ? number : range->least;
        range->most = number > range->most ? number : range->most;
    }
}

/* Returns the level of a number. */
static float level_of(const struct range *range, double number)
{
    const double width = range->most - range->least;
    const double part = width > 0 ? (number - range->least) / width : 0.5;
    if (isnan(number))
        return 0.0f;
    return (float)(255.0 * (part > 0 ? (part < 1 ? part : 1) : 0));
}

static struct kiln_compare_picture *show(const struct kiln_asset_image *image,
                                         const struct range *range)
{
    struct kiln_compare_picture *picture = calloc(1, sizeof *picture);
    const size_t pixels = (size_t)image->width * image->height;
    if (!picture)
        return NULL;
    picture->width = image->width;
    picture->height = image->height;
    picture->levels = malloc(3 * pixels * sizeof *picture->levels);
    if (!picture->levels)
        kiln_compare_picture_destroy(&picture);
    for (size_t i = 0; picture && i < pixels; i++) {
        for (size_t c = 0; c < 3; c++)
            picture->levels[3 * i + c] = level_of(range, number_at(image, 4 * i + c));
    }
    return picture;
}

/* Returns a difference as a part of the largest one. Beside an infinite one, all others are half of
 * it. */
static float part_of(double found, double largest)
{
    if (!(found > 0))
        return 0.0f;
    return isinf(largest) ? (isinf(found) ? 1.0f : 0.5f) : (float)(found / largest);
}

bool kiln_values_show(const struct kiln_asset_image *const images[2], const uint8_t *masked,
                      double largest, struct kiln_compare_picture *pictures[2], float **errors,
                      struct kiln_error *error)
{
    const size_t pixels = (size_t)images[0]->width * images[0]->height;
    struct range range = {INFINITY, -INFINITY};
    uint64_t ignored = 0;
    *errors = malloc(pixels * sizeof **errors);
    for (int i = 0; i < 2; i++)
        widen(&range, images[i]);
    for (int i = 0; i < 2; i++)
        pictures[i] = show(images[i], &range);
    if (!*errors || !pictures[0] || !pictures[1]) {
        free(*errors);
        *errors = NULL;
        kiln_compare_picture_destroy(&pictures[0]);
        kiln_compare_picture_destroy(&pictures[1]);
        return kiln_error_no_memory(error, "a picture of the difference");
    }
    for (size_t i = 0; i < pixels; i++) {
        const bool counts = !masked || !masked[i];
        const double found = counts ? compare_pixel(images, i, &ignored) : 0;
        (*errors)[i] = part_of(found, largest);
    }
    return true;
}
