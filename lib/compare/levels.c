/* Measures differences in levels, and finds the window with most differing pixels. One pass over
 * the pixels fills a summed-area table: for each pixel, how many differing ones lie above and left
 * of it. The count in any window then follows from four of these numbers. */
#include "compare/levels.h"

#include <math.h>
#include <stdlib.h>

#include "base/error.h"

struct scan {
    const struct kiln_compare_picture *reference, *test;
    struct kiln_level_difference *difference;
    double threshold;
    double sum, square_sum;
    uint32_t *table; /* (width + 1) * (height + 1): differing pixels above and left */
};

static void scan_row(struct scan *scan, uint32_t y)
{
    const struct kiln_compare_picture *a = scan->reference, *b = scan->test;
    const uint32_t *above = scan->table + (size_t)y * (a->width + 1);
    uint32_t *below = scan->table + (size_t)(y + 1) * (a->width + 1);
    double sum = 0, square_sum = 0;
    uint32_t in_row = 0;
    for (uint32_t x = 0; x < a->width; x++) {
        size_t i = (size_t)y * a->width + x;
        float worst = a->alpha ? 255.0f * fabsf(a->alpha[i] - b->alpha[i]) : 0.0f;
        sum += (double)worst;
        square_sum += (double)worst * (double)worst;
        for (size_t c = 0; c < 3; c++) {
            float d = fabsf(a->levels[3 * i + c] - b->levels[3 * i + c]);
            worst = d > worst ? d : worst;
            sum += (double)d;
            square_sum += (double)d * (double)d;
        }
        in_row += (double)worst > scan->threshold;
        below[x + 1] = above[x + 1] + in_row;
        if ((double)worst > scan->difference->maximum) {
            scan->difference->maximum = (double)worst;
            scan->difference->x = x;
            scan->difference->y = y;
        }
    }
    scan->sum += sum;
    scan->square_sum += square_sum;
}

static void find_window(const struct scan *scan, uint32_t edge)
{
    struct kiln_level_difference *d = scan->difference;
    uint32_t width = scan->reference->width, height = scan->reference->height;
    d->window_width = edge < width ? edge : width;
    d->window_height = edge < height ? edge : height;
    for (uint32_t y = 0; y + d->window_height <= height; y++) {
        const uint32_t *top = scan->table + (size_t)y * (width + 1);
        const uint32_t *bottom = top + (size_t)d->window_height * (width + 1);
        for (uint32_t x = 0; x + d->window_width <= width; x++) {
            uint32_t count =
                bottom[x + d->window_width] - bottom[x] - top[x + d->window_width] + top[x];
            if (count > d->window_differing) {
                d->window_differing = count;
                d->window_x = x;
                d->window_y = y;
            }
        }
    }
}

bool kiln_level_difference_measure(const struct kiln_compare_picture *reference,
                                   const struct kiln_compare_picture *test, double threshold,
                                   uint32_t window, struct kiln_level_difference *difference,
                                   struct kiln_error *error)
{
    uint32_t width = reference->width, height = reference->height;
    *difference = (struct kiln_level_difference){0};
    struct scan scan = {.reference = reference,
                        .test = test,
                        .difference = difference,
                        .threshold = threshold,
                        .table = calloc((size_t)(width + 1) * (height + 1), sizeof(uint32_t))};
    if (!scan.table)
        return kiln_error_no_memory(error, "comparing %u x %u pixels", width, height);
    for (uint32_t y = 0; y < height; y++)
        scan_row(&scan, y);
    double values = (double)width * height * (reference->alpha ? 4.0 : 3.0);
    difference->mean = scan.sum / values;
    difference->mean_square = scan.square_sum / values;
    difference->differing = scan.table[(size_t)(width + 1) * (height + 1) - 1];
    find_window(&scan, window);
    free(scan.table);
    return true;
}
