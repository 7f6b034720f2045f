/* Paints the marks of a drawing in pixels, in arithmetic that rounds alike on every machine. Of
 * libm, it uses functions whose results are exact, such as sqrt, and pow, whose results it rounds
 * to whole numbers. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "figure/drawing.h"
#include "figure/font.h"

/* ---- Pictures ------------------------------------------------------------------------------- */

/* Makes a table of the linear light of each sRGB level, 0 to 65535. The values are rounded to whole
 * numbers, which are the same with any libm. */
static void make_light(uint32_t light[256])
{
    for (int i = 0; i < 256; i++) {
        double v = i / 255.0;
        double linear = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
        light[i] = (uint32_t)(linear * 65535.0 + 0.5);
    }
}

static uint8_t level_of(const uint32_t light[256], uint64_t value)
{
    int low = 0, high = 255;
    while (low < high) {
        int middle = (low + high) / 2;
        if (light[middle] + (uint64_t)light[middle + 1] < 2 * value)
            low = middle + 1;
        else
            high = middle;
    }
    return (uint8_t)low;
}

struct span {
    uint32_t first, last;           /* source pixels, both included */
    uint32_t first_part, last_part; /* how much of the pixel is covered, in 1/256 */
};

static struct span span_of(uint32_t i, uint32_t from, uint32_t to)
{
    uint64_t begin = (uint64_t)i * from * 256 / to, end = (uint64_t)(i + 1) * from * 256 / to;
    if (from <= to)
        return (struct span){(uint32_t)((uint64_t)i * from / to),
                             (uint32_t)((uint64_t)i * from / to), 256, 256};
    uint32_t last = (uint32_t)((end - 1) / 256);
    return (struct span){(uint32_t)(begin / 256), last, 256 - (uint32_t)(begin % 256),
                         (uint32_t)(end - (uint64_t)last * 256)};
}

static uint32_t coverage_of(const struct span *span, uint32_t i)
{
    uint32_t part = i == span->first ? span->first_part : 256;
    return i == span->last && span->last_part < part ? span->last_part : part;
}

static void average(const struct kiln_pixels *pixels, const uint32_t light[256],
                    const struct span *columns, const struct span *rows, uint8_t out[4])
{
    uint64_t sum[3] = {0}, weights = 0;
    for (uint32_t y = rows->first; y <= rows->last; y++) {
        const uint8_t *row = pixels->rgba + (size_t)y * pixels->width * 4;
        for (uint32_t x = columns->first; x <= columns->last; x++) {
            uint64_t weight = (uint64_t)coverage_of(rows, y) * coverage_of(columns, x);
            weights += weight;
            for (int c = 0; c < 3; c++)
                sum[c] += weight * light[row[4 * x + (uint32_t)c]];
        }
    }
    for (int c = 0; c < 3; c++)
        out[c] = level_of(light, (sum[c] + weights / 2) / weights);
    out[3] = 255;
}

bool kiln_pixels_resize(const struct kiln_pixels *pixels, uint32_t width, uint32_t height,
                        uint8_t *out)
{
    uint32_t light[256];
    make_light(light);
    struct span *columns = malloc((size_t)width * sizeof *columns);
    if (!columns)
        return false;
    for (uint32_t x = 0; x < width; x++)
        columns[x] = span_of(x, pixels->width, width);
    bool enlarged = pixels->width <= width && pixels->height <= height;
    for (uint32_t y = 0; y < height; y++) {
        struct span rows = span_of(y, pixels->height, height);
        const uint8_t *row = pixels->rgba + (size_t)rows.first * pixels->width * 4;
        for (uint32_t x = 0; x < width; x++, out += 4) {
            if (enlarged)
                memcpy(out, row + (size_t)columns[x].first * 4, 4);
            else
                average(pixels, light, &columns[x], &rows, out);
        }
    }
    free(columns);
    return true;
}

/* ---- Strokes -------------------------------------------------------------------------------- */

/* A rectangle of pixels, and how much of each the pen has covered, 0 to 1. */
struct stencil {
    int32_t x, y;
    uint32_t width, height;
    float *cover;
    double origin_x, origin_y, scale; /* origin and scale of the text, in pixels */
    double half_pen;
    double px, py; /* position of the pen, in pixels */
};

/* Returns how much of the pixel around a point (x, y) a stroke from (0, 0) to (dx, dy) covers. */
static double cover_at(double x, double y, double dx, double dy, double half_pen)
{
    double length = dx * dx + dy * dy, t = length > 0 ? (x * dx + y * dy) / length : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    double ex = x - t * dx, ey = y - t * dy;
    double cover = half_pen + 0.5 - sqrt(ex * ex + ey * ey);
    return cover < 0 ? 0 : cover > 1 ? 1 : cover;
}

/* Clips a range of pixels to those of the stencil; the result counts from the stencil's start and
 * excludes its end. */
static void clip(double low, double high, int32_t start, uint32_t size, uint32_t range[2])
{
    double first = floor(low) - start, last = ceil(high) - start;
    range[0] = first > 0 ? (uint32_t)first : 0;
    range[1] = last < 0 ? 0 : last < size ? (uint32_t)last : size;
}

static void cover_segment(struct stencil *s, double ax, double ay, double bx, double by)
{
    double reach = s->half_pen + 1;
    uint32_t columns[2], rows[2];
    clip(fmin(ax, bx) - reach, fmax(ax, bx) + reach, s->x, s->width, columns);
    clip(fmin(ay, by) - reach, fmax(ay, by) + reach, s->y, s->height, rows);
    for (uint32_t y = rows[0]; y < rows[1]; y++) {
        for (uint32_t x = columns[0]; x < columns[1]; x++) {
            double cover = cover_at((double)x + s->x + 0.5 - ax, (double)y + s->y + 0.5 - ay,
                                    bx - ax, by - ay, s->half_pen);
            float *place = &s->cover[(size_t)y * s->width + x];
            *place = (float)cover > *place ? (float)cover : *place;
        }
    }
}

static void pen_move(void *user, double x, double y)
{
    struct stencil *s = user;
    s->px = s->origin_x + x * s->scale;
    s->py = s->origin_y - y * s->scale;
}

static void pen_line(void *user, double x, double y)
{
    struct stencil *s = user;
    double ax = s->px, ay = s->py;
    pen_move(s, x, y);
    cover_segment(s, ax, ay, s->px, s->py);
}

static void pen_curve(void *user, const double p[6])
{
    enum { PIECES = 10 };
    struct stencil *s = user;
    double x = (s->px - s->origin_x) / s->scale, y = (s->origin_y - s->py) / s->scale;
    for (int i = 1; i <= PIECES; i++) {
        double t = (double)i / PIECES, u = 1 - t;
        double a = u * u * u, b = 3 * u * u * t, c = 3 * u * t * t, d = t * t * t;
        pen_line(s, a * x + b * p[0] + c * p[2] + d * p[4], a * y + b * p[1] + c * p[3] + d * p[5]);
    }
}

static void blend(uint8_t *pixel, uint32_t color, float cover)
{
    for (int c = 0; c < 3; c++) {
        float ink = (float)((color >> (16 - 8 * c)) & 255);
        pixel[c] = (uint8_t)((float)pixel[c] + (ink - (float)pixel[c]) * cover + 0.5f);
    }
}

static bool paint_text(const struct kiln_mark *mark, const struct kiln_pixels *out)
{
    double scale = mark->capital / KILN_FONT_CAPITAL;
    uint32_t capital = (uint32_t)ceil(mark->capital);
    struct stencil s = {
        .x = mark->x - 2,
        .y = mark->y - (int32_t)capital * 3 / 2 - 2,
        .width = kiln_drawing_text_width(mark->text, mark->capital) + 4,
        .height = capital * 2 + 4,
        .origin_x = mark->x,
        /* The half pixel lets a stroke along the baseline, or along the height of capitals, fill a
         * row of pixels. */
        .origin_y = mark->y - 0.5,
        .scale = scale,
        .half_pen = scale * KILN_FONT_PEN / 2,
    };
    s.cover = calloc((size_t)s.width * s.height, sizeof *s.cover);
    if (!s.cover)
        return false;
    kiln_font_draw(mark->text, &(struct kiln_font_pen){pen_move, pen_line, pen_curve, &s});
    for (uint32_t i = 0; i < s.width * s.height; i++) {
        int64_t x = s.x + (int64_t)(i % s.width), y = s.y + (int64_t)(i / s.width);
        if (s.cover[i] > 0 && x >= 0 && y >= 0 && x < out->width && y < out->height)
            blend(out->rgba + 4 * ((size_t)y * out->width + (size_t)x), mark->color, s.cover[i]);
    }
    free(s.cover);
    return true;
}

/* ---- Marks ---------------------------------------------------------------------------------- */

static void fill(const struct kiln_pixels *out, int64_t x0, int64_t y0, int64_t x1, int64_t y1,
                 uint32_t color)
{
    for (int64_t y = y0 > 0 ? y0 : 0; y < y1 && y < out->height; y++) {
        for (int64_t x = x0 > 0 ? x0 : 0; x < x1 && x < out->width; x++) {
            uint8_t *pixel = out->rgba + 4 * ((size_t)y * out->width + (size_t)x);
            blend(pixel, color, 1);
            pixel[3] = 255;
        }
    }
}

static void paint_frame(const struct kiln_mark *mark, const struct kiln_pixels *out)
{
    int64_t x0 = mark->x, y0 = mark->y, x1 = x0 + mark->width, y1 = y0 + mark->height;
    int64_t s = mark->stroke;
    fill(out, x0, y0, x1, y0 + s, mark->color);
    fill(out, x0, y1 - s, x1, y1, mark->color);
    fill(out, x0, y0 + s, x0 + s, y1 - s, mark->color);
    fill(out, x1 - s, y0 + s, x1, y1 - s, mark->color);
}

/* Paints a picture. It does not clip, since the layout keeps pictures on the paper. */
static bool paint_picture(const struct kiln_mark *mark, const struct kiln_pixels *out)
{
    uint8_t *resized = malloc((size_t)mark->width * mark->height * 4);
    bool ok = resized && kiln_pixels_resize(&mark->pixels, mark->width, mark->height, resized);
    for (uint32_t y = 0; ok && y < mark->height; y++)
        memcpy(out->rgba + 4 * ((size_t)(mark->y + (int32_t)y) * out->width + (size_t)mark->x),
               resized + (size_t)y * mark->width * 4, (size_t)mark->width * 4);
    free(resized);
    return ok;
}

static bool paint(const struct kiln_mark *mark, const struct kiln_pixels *out)
{
    switch (mark->kind) {
    case KILN_MARK_PICTURE:
        return paint_picture(mark, out);
    case KILN_MARK_FILL:
        fill(out, mark->x, mark->y, (int64_t)mark->x + mark->width, (int64_t)mark->y + mark->height,
             mark->color);
        return true;
    case KILN_MARK_FRAME:
        paint_frame(mark, out);
        return true;
    case KILN_MARK_TEXT:
        return paint_text(mark, out);
    }
    return true;
}

bool kiln_drawing_rasterise(const struct kiln_drawing *drawing, struct kiln_pixels *pixels,
                            struct kiln_error *error)
{
    size_t count = (size_t)drawing->width * drawing->height;
    *pixels = (struct kiln_pixels){drawing->width, drawing->height, calloc(count, 4)};
    bool ok = pixels->rgba && !drawing->failed;
    if (ok)
        fill(pixels, 0, 0, drawing->width, drawing->height, drawing->paper);
    for (size_t i = 0; ok && i < drawing->count; i++)
        ok = paint(&drawing->marks[i], pixels);
    if (ok)
        return true;
    free(pixels->rgba);
    *pixels = (struct kiln_pixels){0};
    return kiln_error_no_memory(error, "a figure of %u x %u pixels", drawing->width,
                                drawing->height);
}
