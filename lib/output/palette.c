/* Chooses a palette for a clip and dithers frames with it. Colours are counted over the whole clip,
 * so that one palette serves all frames: with one for each frame, still pixels would flicker. Boxes
 * of colours are split where the error is largest, and the result is refined by a few rounds of
 * k-means.
 *
 * Dither is ordered, since diffused errors move with the picture and flicker where it is still. A
 * palette is no regular grid, so the pattern cannot just shift a colour. Instead, the 16 palette
 * colours whose average comes nearest to it are found, each making up for the error of those
 * before, sorted by brightness, and dealt out over 4x4 pixels (Knoll's pattern dithering). Still
 * pixels stay as they are from frame to frame, which also makes files small. */
#include "output/palette.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"

enum {
    COUNT_BITS = 6,
    COUNT_CELLS = 1 << (3 * COUNT_BITS),
    MIX_BITS = 7,
    MIX_LEVELS = 1 << MIX_BITS,
    MIX_CELLS = 1 << (3 * MIX_BITS),
    PATTERN_EDGE = 4,
    PATTERN_SIZE = PATTERN_EDGE * PATTERN_EDGE,
    ROUNDS = 6,
};

/* Weights of errors in red, green and blue, by how visible they are. */
static const double channel_weight[3] = {3, 6, 2};

struct histogram_cell {
    uint64_t count, sum[3];
};

struct kiln_histogram {
    struct histogram_cell cells[COUNT_CELLS];
};

static uint32_t cell_index(uint32_t red, uint32_t green, uint32_t blue, uint32_t bits)
{
    return (red << (2 * bits)) | (green << bits) | blue;
}

struct kiln_histogram *kiln_histogram_create(void)
{
    return calloc(1, sizeof(struct kiln_histogram));
}

void kiln_histogram_destroy(struct kiln_histogram **histogram)
{
    free(*histogram);
    *histogram = NULL;
}

void kiln_histogram_add(struct kiln_histogram *histogram, const uint8_t *rgb, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++, rgb += 3) {
        struct histogram_cell *cell =
            &histogram->cells[cell_index(rgb[0] >> 2, rgb[1] >> 2, rgb[2] >> 2, COUNT_BITS)];
        cell->count++;
        for (int c = 0; c < 3; c++)
            cell->sum[c] += rgb[c];
    }
}

/* ---- The palette --------------------------------------------------------------------------- */

struct point {
    double color[3], weight;
};

struct box {
    struct point *points;
    size_t count;
    double mean[3];
    double error; /* sum of the weighted squares of the distances to the mean */
    int axis;     /* the axis with the largest part of the error */
};

static double square(double x)
{
    return x * x;
}

/* Computes the square root to some digits, without the C library's mathematics. */
static double root(double x)
{
    double y = x > 1.0 ? x : 1.0;
    for (int i = 0; i < 64; i++)
        y = 0.5 * (y + x / y);
    return y;
}

/* Lists the counted colours with weights. A clip is mostly background, so weights grow with the
 * root of the counts: else background would take all colours from the flame. */
static size_t list_points(const struct kiln_histogram *histogram, struct point *points)
{
    size_t count = 0;
    for (size_t i = 0; i < COUNT_CELLS; i++) {
        const struct histogram_cell *cell = &histogram->cells[i];
        if (cell->count == 0)
            continue;
        struct point *point = &points[count++];
        for (int c = 0; c < 3; c++)
            point->color[c] = (double)cell->sum[c] / (double)cell->count;
        point->weight = root((double)cell->count);
    }
    return count;
}

static void measure_box(struct box *box)
{
    double weight = 0, sum[3] = {0}, most = -1;
    for (size_t i = 0; i < box->count; i++) {
        weight += box->points[i].weight;
        for (int c = 0; c < 3; c++)
            sum[c] += box->points[i].weight * box->points[i].color[c];
    }
    box->error = 0;
    for (int c = 0; c < 3; c++) {
        box->mean[c] = sum[c] / weight;
        double error = 0;
        for (size_t i = 0; i < box->count; i++)
            error += box->points[i].weight * square(box->points[i].color[c] - box->mean[c]);
        error *= channel_weight[c];
        box->error += error;
        if (error > most) {
            most = error;
            box->axis = c;
        }
    }
}

/* Cuts a box of more than one point at its mean. The points are reordered, always in the same way.
 * False when, by rounding, all points are on one side of the mean: then they are nearly equal. */
static bool split_box(struct box *box, struct box *upper)
{
    size_t begin = 0, end = box->count;
    while (begin < end) {
        if (box->points[begin].color[box->axis] <= box->mean[box->axis]) {
            begin++;
        } else {
            struct point point = box->points[begin];
            box->points[begin] = box->points[--end];
            box->points[end] = point;
        }
    }
    if (begin == 0 || begin == box->count)
        return false;
    *upper = (struct box){.points = box->points + begin, .count = box->count - begin};
    box->count = begin;
    measure_box(box);
    measure_box(upper);
    return true;
}

/* Splits boxes and returns the number of boxes; 0 when the caller wants no more. */
static uint32_t split_all(struct box *boxes, uint32_t most, const struct kiln_caller *caller,
                          struct kiln_error *error)
{
    uint32_t count = 1;
    measure_box(&boxes[0]);
    while (count < most) {
        if (!kiln_may_go_on(caller, error))
            return 0;
        struct box *worst = &boxes[0];
        for (uint32_t i = 1; i < count; i++)
            worst = boxes[i].error > worst->error ? &boxes[i] : worst;
        if (worst->error <= 0 || !split_box(worst, &boxes[count]))
            break;
        count++;
    }
    return count;
}

static uint32_t nearest(const double (*colors)[3], uint32_t count, const double color[3])
{
    uint32_t best = 0;
    double least = 1e30;
    for (uint32_t i = 0; i < count; i++) {
        double distance = 0;
        for (int c = 0; c < 3; c++)
            distance += channel_weight[c] * square(colors[i][c] - color[c]);
        if (distance < least) {
            least = distance;
            best = i;
        }
    }
    return best;
}

/* Runs one round of k-means. */
static void refine(double (*colors)[3], uint32_t count, const struct point *points,
                   size_t point_count)
{
    double sum[KILN_MAX_PALETTE][3] = {{0}}, weight[KILN_MAX_PALETTE] = {0};
    for (size_t i = 0; i < point_count; i++) {
        uint32_t index = nearest(colors, count, points[i].color);
        weight[index] += points[i].weight;
        for (int c = 0; c < 3; c++)
            sum[index][c] += points[i].weight * points[i].color[c];
    }
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 3 && weight[i] > 0; c++)
            colors[i][c] = sum[i][c] / weight[i];
    }
}

static bool choose_colors(struct kiln_palette *palette, struct point *points, size_t point_count,
                          uint32_t most, const struct kiln_caller *caller, struct kiln_error *error)
{
    struct box boxes[KILN_MAX_PALETTE] = {{.points = points, .count = point_count}};
    double colors[KILN_MAX_PALETTE][3];
    palette->count = split_all(boxes, most, caller, error);
    if (palette->count == 0)
        return false;
    for (uint32_t i = 0; i < palette->count; i++)
        memcpy(colors[i], boxes[i].mean, sizeof colors[i]);
    for (int round = 0; round < ROUNDS; round++) {
        if (!kiln_may_go_on(caller, error))
            return false;
        refine(colors, palette->count, points, point_count);
    }
    for (uint32_t i = 0; i < palette->count; i++) {
        for (int c = 0; c < 3; c++)
            palette->colors[i][c] = (uint8_t)(colors[i][c] + 0.5);
    }
    return true;
}

bool kiln_palette_make(struct kiln_palette *palette, const struct kiln_histogram *histogram,
                       uint32_t most, const struct kiln_caller *caller, struct kiln_error *error)
{
    *palette = (struct kiln_palette){.count = 1};
    struct point *points = malloc(COUNT_CELLS * sizeof *points);
    if (!points)
        return kiln_error_no_memory(error, "the palette");
    size_t point_count = list_points(histogram, points);
    bool good =
        point_count == 0 || choose_colors(palette, points, point_count, most, caller, error);
    free(points);
    return good;
}

/* ---- Dither -------------------------------------------------------------------------------- */

struct kiln_dither {
    uint32_t count;
    double colors[KILN_MAX_PALETTE][3];
    double luma[KILN_MAX_PALETTE];
    uint8_t mixes[MIX_CELLS][PATTERN_SIZE]; /* palette indices of each mix, from dark to bright */
    bool mixed[MIX_CELLS];
};

struct kiln_dither *kiln_dither_create(const struct kiln_palette *palette)
{
    struct kiln_dither *dither = calloc(1, sizeof *dither);
    if (!dither)
        return NULL;
    dither->count = palette->count;
    for (uint32_t i = 0; i < palette->count; i++) {
        for (int c = 0; c < 3; c++) {
            dither->colors[i][c] = palette->colors[i][c];
            dither->luma[i] += channel_weight[c] * palette->colors[i][c];
        }
    }
    return dither;
}

void kiln_dither_destroy(struct kiln_dither **dither)
{
    free(*dither);
    *dither = NULL;
}

static void mix(struct kiln_dither *dither, const uint32_t cell[3], uint8_t out[PATTERN_SIZE])
{
    double color[3], wanted[3];
    for (int c = 0; c < 3; c++)
        wanted[c] = color[c] = (double)cell[c] * 255.0 / (MIX_LEVELS - 1);
    for (int n = 0; n < PATTERN_SIZE; n++) {
        uint32_t index = nearest(dither->colors, dither->count, wanted);
        for (int c = 0; c < 3; c++)
            wanted[c] += color[c] - dither->colors[index][c];
        int place = n;
        for (; place > 0 && dither->luma[out[place - 1]] > dither->luma[index]; place--)
            out[place] = out[place - 1];
        out[place] = (uint8_t)index;
    }
}

/* Returns the cell for a level of 8 bits. A level between two cells is spread over blocks of the
 * pattern. */
static uint32_t spread(uint32_t level, uint32_t x, uint32_t y)
{
    static const uint32_t order[2][2] = {{1, 5}, {7, 3}}; /* thresholds, in eighths of a cell */
    uint32_t eighth = order[y / PATTERN_EDGE % 2][x / PATTERN_EDGE % 2];
    return (level * (MIX_LEVELS - 1) * 8 + eighth * 255) / (255 * 8);
}

void kiln_dither_row(struct kiln_dither *dither, uint32_t y, const uint8_t *rgb, uint32_t width,
                     uint8_t *indices)
{
    static const uint8_t bayer[PATTERN_EDGE][PATTERN_EDGE] = {
        {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    for (uint32_t x = 0; x < width; x++, rgb += 3) {
        uint32_t cell[3];
        for (int c = 0; c < 3; c++)
            cell[c] = spread(rgb[c], x, y);
        uint32_t index = cell_index(cell[0], cell[1], cell[2], MIX_BITS);
        if (!dither->mixed[index]) {
            mix(dither, cell, dither->mixes[index]);
            dither->mixed[index] = true;
        }
        indices[x] = dither->mixes[index][bayer[y % PATTERN_EDGE][x % PATTERN_EDGE]];
    }
}
