/* Writes a drawing as SVG. Pictures are embedded as PNG at their own size. Text is drawn as
 * strokes, so that no reader needs a font; over them lies the same text, invisible, which readers
 * select and search. */
#include <stdlib.h>

#include "base/error.h"
#include "figure/drawing.h"
#include "figure/font.h"
#include "report/markup.h"

struct pen {
    FILE *out;
    double x, y, scale;
};

/* Writes a path command and its point, rounded to a hundredth of a pixel. */
static void put_point(const struct pen *pen, char command, double x, double y)
{
    fprintf(pen->out, "%c%.2f %.2f", command, pen->x + x * pen->scale, pen->y - y * pen->scale);
}

static void pen_move(void *user, double x, double y)
{
    put_point(user, 'M', x, y);
}

static void pen_line(void *user, double x, double y)
{
    put_point(user, 'L', x, y);
}

static void pen_curve(void *user, const double p[6])
{
    put_point(user, 'C', p[0], p[1]);
    put_point(user, ' ', p[2], p[3]);
    put_point(user, ' ', p[4], p[5]);
}

static void put_text(FILE *out, const struct kiln_mark *mark)
{
    double scale = mark->capital / KILN_FONT_CAPITAL;
    struct pen pen = {out, mark->x, mark->y - 0.5, scale};
    fprintf(out,
            "<path aria-hidden=\"true\" fill=\"none\" stroke=\"#%06x\" stroke-width=\"%.2f\" "
            "stroke-linecap=\"round\" stroke-linejoin=\"round\" d=\"",
            mark->color, KILN_FONT_PEN * scale);
    kiln_font_draw(mark->text, &(struct kiln_font_pen){pen_move, pen_line, pen_curve, &pen});
    fprintf(out,
            "\"/>\n<text x=\"%d\" y=\"%.1f\" font-family=\"sans-serif\" font-size=\"%.2f\" "
            "textLength=\"%.2f\" lengthAdjust=\"spacingAndGlyphs\" fill=\"#%06x\" "
            "fill-opacity=\"0\" xml:space=\"preserve\">",
            mark->x, mark->y - 0.5, kiln_drawing_font_size(mark->capital),
            kiln_font_width(mark->text) * scale, mark->color);
    kiln_markup_write_text(out, mark->text);
    fputs("</text>\n", out);
}

static void put_frame(FILE *out, const struct kiln_mark *mark)
{
    double half = mark->stroke / 2.0;
    fprintf(out,
            "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" "
            "stroke=\"#%06x\" stroke-width=\"%u\"/>\n",
            mark->x + half, mark->y + half, mark->width - 2 * half, mark->height - 2 * half,
            mark->color, mark->stroke);
}

static bool put_picture(FILE *out, const struct kiln_mark *mark, struct kiln_error *error)
{
    uint8_t *png;
    size_t size;
    if (!kiln_pixels_png(&mark->pixels, NULL, &png, &size, error))
        return false;
    fprintf(out,
            "<image x=\"%d\" y=\"%d\" width=\"%u\" height=\"%u\" preserveAspectRatio=\"none\"%s "
            "href=\"data:image/png;base64,",
            mark->x, mark->y, mark->width, mark->height,
            mark->width > mark->pixels.width ? " image-rendering=\"pixelated\"" : "");
    kiln_markup_write_base64(out, png, size);
    fprintf(out, "\"/>\n");
    free(png);
    return true;
}

static bool put_mark(FILE *out, const struct kiln_mark *mark, struct kiln_error *error)
{
    switch (mark->kind) {
    case KILN_MARK_PICTURE:
        return put_picture(out, mark, error);
    case KILN_MARK_FILL:
        fprintf(out, "<rect x=\"%d\" y=\"%d\" width=\"%u\" height=\"%u\" fill=\"#%06x\"/>\n",
                mark->x, mark->y, mark->width, mark->height, mark->color);
        return true;
    case KILN_MARK_FRAME:
        put_frame(out, mark);
        return true;
    case KILN_MARK_TEXT:
        put_text(out, mark);
        return true;
    }
    return true;
}

/* Writes the start of the document. The document's size is in mm if its size on paper is known,
 * else in pixels. */
static void put_start(FILE *out, const struct kiln_drawing *drawing)
{
    double edge = drawing->pixel_mm > 0 ? drawing->pixel_mm : 1;
    const char *unit = drawing->pixel_mm > 0 ? "mm" : "";
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.7g%s\" height=\"%.7g%s\" "
            "viewBox=\"0 0 %u %u\"",
            drawing->width * edge, unit, drawing->height * edge, unit, drawing->width,
            drawing->height);
    if (drawing->alt) {
        fputs(" role=\"img\" aria-label=\"", out);
        kiln_markup_write_text(out, drawing->alt);
        fputs("\"", out);
    }
    fputs(">\n", out);
    if (drawing->title) {
        fputs("<title>", out);
        kiln_markup_write_text(out, drawing->title);
        fputs("</title>\n", out);
    }
    if (drawing->alt) {
        fputs("<desc>", out);
        kiln_markup_write_text(out, drawing->alt);
        fputs("</desc>\n", out);
    }
}

bool kiln_drawing_svg(const struct kiln_drawing *drawing, uint8_t **bytes, size_t *size,
                      struct kiln_error *error)
{
    char *text = NULL;
    FILE *out = open_memstream(&text, size);
    *bytes = NULL;
    if (!out)
        return kiln_error_no_memory(error, "an SVG document");
    put_start(out, drawing);
    fprintf(out, "<rect width=\"%u\" height=\"%u\" fill=\"#%06x\"/>\n", drawing->width,
            drawing->height, drawing->paper);
    bool ok = true;
    for (size_t i = 0; ok && i < drawing->count; i++)
        ok = put_mark(out, &drawing->marks[i], error);
    fputs("</svg>\n", out);
    bool whole = !ferror(out);
    if (fclose(out) == 0 && whole && ok) {
        *bytes = (uint8_t *)text;
        return true;
    }
    free(text);
    if (ok)
        kiln_error_no_memory(error, "an SVG document");
    return false;
}
