/* Gives a colour to each pixel that has none because its alpha is 0. It averages colours, weighted
 * by alpha, over squares of pixels of doubling size; a pixel without a colour takes that of the
 * smallest square around it that has one. */
#include "output/bleed.h"

#include <stdlib.h>

#include "base/error.h"

enum { MAX_LEVELS = 32 };

struct cell {
    float color[3]; /* sum of colour * alpha */
    float alpha;    /* sum */
};

struct level {
    uint32_t width, height;
    struct cell *cells;
};

static uint32_t read_sample(const struct kiln_picture *picture, size_t index)
{
    return picture->bits == 8 ? ((const uint8_t *)picture->display)[index]
                              : ((const uint16_t *)picture->display)[index];
}

static void write_sample(const struct kiln_picture *picture, size_t index, float value)
{
    if (picture->bits == 8)
        ((uint8_t *)picture->display)[index] = (uint8_t)(value + 0.5f);
    else
        ((uint16_t *)picture->display)[index] = (uint16_t)(value + 0.5f);
}

static void add(struct cell *sum, const struct cell *cell)
{
    for (int c = 0; c < 3; c++)
        sum->color[c] += cell->color[c];
    sum->alpha += cell->alpha;
}

/* Sums the pixels of each square of 2x2. */
static void sum_pixels(const struct kiln_picture *picture, const struct level *level)
{
    size_t index = 0;
    for (uint32_t y = 0; y < picture->height; y++) {
        struct cell *row = level->cells + (size_t)(y / 2) * level->width;
        for (uint32_t x = 0; x < picture->width; x++, index += 4) {
            struct cell pixel = {.alpha = (float)read_sample(picture, index + 3)};
            for (size_t c = 0; c < 3; c++)
                pixel.color[c] = pixel.alpha * (float)read_sample(picture, index + c);
            add(&row[x / 2], &pixel);
        }
    }
}

static void sum_level(const struct level *fine, const struct level *coarse)
{
    for (uint32_t y = 0; y < fine->height; y++) {
        for (uint32_t x = 0; x < fine->width; x++)
            add(&coarse->cells[(size_t)(y / 2) * coarse->width + x / 2],
                &fine->cells[(size_t)y * fine->width + x]);
    }
}

static void fill_pixels(const struct kiln_picture *picture, const struct level *levels,
                        uint32_t level_count)
{
    size_t index = 0;
    for (uint32_t y = 0; y < picture->height; y++) {
        for (uint32_t x = 0; x < picture->width; x++, index += 4) {
            if (read_sample(picture, index + 3) > 0)
                continue;
            const struct cell *cell = NULL;
            for (uint32_t i = 0; i < level_count && (!cell || cell->alpha <= 0.0f); i++)
                cell = &levels[i].cells[(size_t)(y >> (i + 1)) * levels[i].width + (x >> (i + 1))];
            for (size_t c = 0; c < 3; c++)
                write_sample(picture, index + c,
                             cell->alpha > 0.0f ? cell->color[c] / cell->alpha : 0.0f);
        }
    }
}

bool kiln_bleed_colors(const struct kiln_picture *picture, struct kiln_error *error)
{
    struct level levels[MAX_LEVELS];
    uint32_t count = 0, width = picture->width, height = picture->height;
    bool good = true;
    do {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
        levels[count] =
            (struct level){width, height, calloc((size_t)width * height, sizeof(struct cell))};
        good = levels[count].cells != NULL;
        if (good && count == 0)
            sum_pixels(picture, &levels[0]);
        else if (good)
            sum_level(&levels[count - 1], &levels[count]);
        count++;
    } while (good && (width > 1 || height > 1));
    if (good)
        fill_pixels(picture, levels, count);
    for (uint32_t i = 0; i < count; i++)
        free(levels[i].cells);
    return good || kiln_error_no_memory(error, "the colours of edges");
}
