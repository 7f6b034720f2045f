/* This file computes colours from luminance and chroma, as OpenEXR's RgbaInputFile does (Technical
 * Introduction to OpenEXR, "Luminance/Chroma Images"; ImfRgbaYca): chroma that is stored for two by
 * two pixels is interpolated by a filter of 27 taps, of which every other one is 0, and pixels that
 * the filter made too colourful are desaturated. */
#include <stdlib.h>
#include <string.h>

#include "exr.h"

/* Weights of the 14 samples around a pixel between two samples (ImfRgbaYca.cpp,
 * reconstructChromaHoriz); the filter is symmetric. */
static const float weights_of_taps[7] = {0.002128f, -0.007540f, 0.019597f, -0.043159f,
                                         0.087929f, -0.186077f, 0.627123f};

/* Returns a value between samples k and k + 1 of a row or a column, where k is -1 or more. Beyond
 * its ends, the samples repeat. */
static float between(const float *samples, size_t step, uint32_t count, int64_t k)
{
    const int64_t last = (int64_t)count - 1;
    float sum = 0.0f;
    for (int tap = 0; tap < 7; tap++) {
        const int64_t before = k - (6 - tap), behind = k + (7 - tap);
        sum += weights_of_taps[tap] * (samples[step * (size_t)(before > 0 ? before : 0)] +
                                       samples[step * (size_t)(behind < last ? behind : last)]);
    }
    return sum;
}

/* Computes a line of chroma for each pixel; y is -1 or more. line: room for the samples of a line.
 */
static void find_chroma(const struct exr_reading *reading, const float *plane, int64_t y,
                        float *line, float *chroma)
{
    const uint32_t columns = reading->chroma_width, rows = reading->chroma_height;
    if (reading->layer.sampling == 1) {
        memcpy(chroma, plane + (size_t)y * columns, columns * sizeof *chroma);
        return;
    }
    for (uint32_t x = 0; x < columns; x++)
        line[x] = y % 2 ? between(plane + x, columns, rows, (y + 1) / 2 - 1)
                        : plane[(size_t)(y / 2) * columns + x];
    for (uint32_t x = 0; x < reading->data.width; x++)
        chroma[x] = x % 2 ? between(line, 1, columns, x / 2) : line[x / 2];
}

static void find_colors(float *pixel, const float *ry, const float *by, uint32_t width,
                        const double weights[3])
{
    for (uint32_t x = 0; x < width; x++, pixel += 4) {
        const double luminance = (double)pixel[0];
        if (ry[x] == 0.0f && by[x] == 0.0f) {
            pixel[1] = pixel[2] = pixel[0];
            continue;
        }
        const double red = ((double)ry[x] + 1.0) * luminance;
        const double blue = ((double)by[x] + 1.0) * luminance;
        pixel[0] = (float)red;
        pixel[1] = (float)((luminance - red * weights[0] - blue * weights[2]) / weights[1]);
        pixel[2] = (float)blue;
    }
}

/* ---- saturation ------------------------------------------------------------------------------ */

static float most_of(const float *pixel)
{
    const float most = pixel[0] > pixel[1] ? pixel[0] : pixel[1];
    return most > pixel[2] ? most : pixel[2];
}

static float saturation_of(const float *pixel)
{
    const float most = most_of(pixel);
    float least = pixel[0] < pixel[1] ? pixel[0] : pixel[1];
    least = least < pixel[2] ? least : pixel[2];
    return most > 0.0f ? 1.0f - least / most : 0.0f;
}

static double luminance_of(const float *pixel, const double weights[3])
{
    return (double)pixel[0] * weights[0] + (double)pixel[1] * weights[1] +
           (double)pixel[2] * weights[2];
}

/* Lessens the saturation of a pixel by a factor, and keeps its luminance. */
static void desaturate(float *pixel, float factor, const double weights[3])
{
    const float most = most_of(pixel);
    const double before = luminance_of(pixel, weights);
    for (int c = 0; c < 3; c++) {
        const float value = most - (most - pixel[c]) * factor;
        pixel[c] = value > 0.0f ? value : 0.0f;
    }
    const double after = luminance_of(pixel, weights);
    for (int c = 0; c < 3 && after > 0.0; c++)
        pixel[c] = (float)((double)pixel[c] * (before / after));
}

static float least_float(float a, float b)
{
    return a < b ? a : b;
}

/* Desaturates the pixels of a row that are far more saturated than the four pixels diagonally
 * around them. above, below: the lines as they were before this change. */
static void fix_row(float *row, const float *above, const float *below, uint32_t width,
                    const double weights[3])
{
    for (uint32_t x = 0; x < width; x++) {
        const size_t left = (size_t)4 * (x > 0 ? x - 1 : 0);
        const size_t right = (size_t)4 * (x + 1 < width ? x + 1 : x);
        const float mean =
            least_float(1.0f, 0.25f * (saturation_of(above + left) + saturation_of(above + right) +
                                       saturation_of(below + left) + saturation_of(below + right)));
        const float most = least_float(1.0f, 1.0f - (1.0f - mean) * 0.25f);
        const float own = saturation_of(row + (size_t)4 * x);
        if (own > mean && own > most)
            desaturate(row + (size_t)4 * x, most / own, weights);
    }
}

/* lines: room for two lines of pixels. first: the line above the picture. The one below the picture
 * is the last but one. */
static void fix_saturation(struct exr_reading *reading, float *lines, const float *first,
                           const double weights[3])
{
    const uint32_t width = reading->data.width, height = reading->data.height;
    const size_t size = (size_t)width * 4;
    float *pixels = reading->image->pixels;
    for (uint32_t y = 0; y < height; y++) {
        float *row = pixels + y * size;
        float *own = lines + (y % 2) * size;
        const float *above = y > 0 ? lines + (y + 1) % 2 * size : first;
        const float *below = y + 1 < height ? row + size : above;
        memcpy(own, row, size * sizeof *own);
        fix_row(row, above, below, width, weights);
    }
}

/* Computes the colours of a line of pixels, of which the red is the luminance. room: for three
 * floats a pixel. */
static void show_line(const struct exr_reading *reading, int64_t y, float *pixels, float *room,
                      const double weights[3])
{
    const uint32_t width = reading->data.width;
    float *line = room, *ry = room + width, *by = room + (size_t)2 * width;
    find_chroma(reading, reading->chroma[0], y, line, ry);
    find_chroma(reading, reading->chroma[1], y, line, by);
    find_colors(pixels, ry, by, width, weights);
}

bool decode_exr_chroma(struct exr_reading *reading, const double weights[3])
{
    const size_t size = (size_t)reading->data.width * 4;
    float *pixels = reading->image->pixels;
    float *room = malloc(size * 3 * sizeof *room);
    if (!room)
        return decode_out_of_memory(reading->picture->error);
    float *first = room + 2 * size;
    memcpy(first, pixels, size * sizeof *first);
    if (reading->layer.sampling == 2)
        show_line(reading, -1, first, room, weights);
    for (uint32_t y = 0; y < reading->data.height; y++)
        show_line(reading, y, pixels + y * size, room, weights);
    if (reading->layer.sampling == 2)
        fix_saturation(reading, room, first, weights);
    free(room);
    return true;
}
