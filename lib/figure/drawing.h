/* Describes a figure as a list of marks, which are painted in this order: as pixels (raster.c), as
 * SVG (svg.c) or as PDF (pdf.c). Lengths are in pixels, from the upper left corner; y goes down. */
#ifndef KILN_FIGURE_DRAWING_H
#define KILN_FIGURE_DRAWING_H

#include "base/arena.h"
#include "kiln.h"

/* A picture as RGBA of 8 bits, sRGB, opaque, rows from the top. */
struct kiln_pixels {
    uint32_t width, height;
    uint8_t *rgba;
};

enum kiln_mark_kind {
    KILN_MARK_PICTURE, /* a picture in the rectangle: reduced by averaging, enlarged by repeating
                          pixels */
    KILN_MARK_FILL,    /* the rectangle, filled with `color` */
    KILN_MARK_FRAME,   /* an outline, `stroke` pixels wide, inside the rectangle's edge */
    KILN_MARK_TEXT,    /* a text from x on the baseline y; its capitals are `capital` high */
};

struct kiln_mark {
    enum kiln_mark_kind kind;
    int32_t x, y;
    uint32_t width, height;
    double capital;
    uint32_t color; /* 0xRRGGBB */
    uint32_t stroke;
    struct kiln_pixels pixels;
    const char *text;
};

enum { KILN_MAX_FIGURE_EDGE = 32768, KILN_MAX_FIGURE_PIXELS = 1 << 27 };

struct kiln_drawing {
    struct kiln_arena *arena; /* holds the marks and all that they refer to */
    uint32_t width, height;
    uint32_t paper;  /* 0xRRGGBB */
    double pixel_mm; /* the edge of a pixel on paper; 0: unknown, and SVG and PDF take 1/96 inch */
    const char *title; /* for screen readers; may be NULL */
    const char *alt;   /* a description in place of the pictures, for screen readers; may be NULL */
    struct kiln_mark *marks;
    size_t count, capacity;
    bool failed; /* memory ran out, so marks are missing */
};

/* Adds a copy of a mark; sets `failed` when memory is short. */
void kiln_drawing_add(struct kiln_drawing *drawing, const struct kiln_mark *mark);

/* Returns the width of a text in pixels, rounded up; `capital` is the height of its capitals. */
uint32_t kiln_drawing_text_width(const char *text, double capital);

/* Returns the font size (the em, in pixels) of text whose capitals are `capital` pixels high. */
double kiln_drawing_font_size(double capital);

/* Paints the drawing in pixels, which the caller frees. The bytes are the same on every machine.
 * False with KILN_DEVICE_FAILED when memory is short. */
bool kiln_drawing_rasterise(const struct kiln_drawing *drawing, struct kiln_pixels *pixels,
                            struct kiln_error *error);

/* Resizes a picture: averages its linear light where it is reduced, repeats pixels where it is
 * enlarged. `out` has room for width * height pixels. False when memory is short. */
bool kiln_pixels_resize(const struct kiln_pixels *pixels, uint32_t width, uint32_t height,
                        uint8_t *out);

/* The data that a PNG or JPEG file carries beside its pixels. */
struct kiln_imprint {
    uint32_t dpi;    /* pixels an inch; 0: unknown */
    const char *alt; /* UTF-8; may be NULL */
};

/* These four encode a figure as a PNG file, a JPEG file, an SVG document and a PDF of one page. The
 * caller frees the bytes. A JPEG has a fixed quality (quantiser 2 on FFmpeg's scale to 31) and full
 * chroma. `imprint` may be NULL. */
bool kiln_pixels_png(const struct kiln_pixels *pixels, const struct kiln_imprint *imprint,
                     uint8_t **bytes, size_t *size, struct kiln_error *error);
bool kiln_pixels_jpeg(const struct kiln_pixels *pixels, const struct kiln_imprint *imprint,
                      uint8_t **bytes, size_t *size, struct kiln_error *error);
bool kiln_drawing_svg(const struct kiln_drawing *drawing, uint8_t **bytes, size_t *size,
                      struct kiln_error *error);
bool kiln_drawing_pdf(const struct kiln_drawing *drawing, uint8_t **bytes, size_t *size,
                      struct kiln_error *error);

#endif
