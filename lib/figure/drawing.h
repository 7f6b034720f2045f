/* Describes a figure as a list of marks on paper, which is painted in their order: in pixels
 * (raster.c), as SVG (svg.c) or as PDF (pdf.c). Lengths are pixels, from the upper left corner. */
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
    KILN_MARK_PICTURE, /* fills the rectangle: reduced by averages, enlarged by repetition */
    KILN_MARK_FILL,    /* the rectangle in one colour */
    KILN_MARK_FRAME,   /* inside the rectangle's edge, `stroke` wide */
    KILN_MARK_TEXT,    /* from x, on the baseline y, with capitals as high as `capital` */
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
    struct kiln_arena *arena; /* of the marks and all that they refer to */
    uint32_t width, height;
    uint32_t paper;    /* 0xRRGGBB */
    double pixel_mm;   /* the edge of a pixel on paper; 0: not said, vectors have 96 an inch */
    const char *title; /* for screen readers; may be NULL */
    const char *alt;   /* a description in place of the pictures, for screen readers; may be NULL */
    struct kiln_mark *marks;
    size_t count, capacity;
    bool failed; /* memory was short: the marks are not all there */
};

/* Adds a mark. */
void kiln_drawing_add(struct kiln_drawing *drawing, const struct kiln_mark *mark);

/* The width of a text in pixels, with capitals of that height. */
uint32_t kiln_drawing_text_width(const char *text, double capital);

/* Returns the size of the em, by which other programs count fonts, for capitals of that height. */
double kiln_drawing_font_size(double capital);

/* Paints the drawing in pixels, which the caller frees. The bytes are the same on every machine.
 * False with KILN_USAGE when the drawing is too large, KILN_DEVICE_FAILED when memory is short. */
bool kiln_drawing_rasterise(const struct kiln_drawing *drawing, struct kiln_pixels *pixels,
                            struct kiln_error *error);

/* Resizes a picture: averages of its light where it is reduced, repeated pixels where it is
 * enlarged. out has room for width * height pixels. */
bool kiln_pixels_resize(const struct kiln_pixels *pixels, uint32_t width, uint32_t height,
                        uint8_t *out);

/* The data that a PNG or JPEG file carries beside its pixels. */
struct kiln_imprint {
    uint32_t dpi;    /* pixels an inch; 0: not said */
    const char *alt; /* UTF-8; may be NULL */
};

/* Make the bytes of a PNG file, of a JPEG file, of an SVG document, of a PDF of one page; the
 * caller frees them. A JPEG has a fixed quality (a quantiser of 2 of FFmpeg's 31) and full chroma.
 * imprint may be NULL. */
bool kiln_pixels_png(const struct kiln_pixels *pixels, const struct kiln_imprint *imprint,
                     uint8_t **bytes, size_t *size, struct kiln_error *error);
bool kiln_pixels_jpeg(const struct kiln_pixels *pixels, const struct kiln_imprint *imprint,
                      uint8_t **bytes, size_t *size, struct kiln_error *error);
bool kiln_drawing_svg(const struct kiln_drawing *drawing, uint8_t **bytes, size_t *size,
                      struct kiln_error *error);
bool kiln_drawing_pdf(const struct kiln_drawing *drawing, uint8_t **bytes, size_t *size,
                      struct kiln_error *error);

#endif
