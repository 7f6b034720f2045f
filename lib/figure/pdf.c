/* PDF 1.4, one page: pictures as deflated RGB, lettering as strokes. Nothing in it tells of the
 * time or the machine. A pixel is 1/96 of an inch, three quarters of a point. */
#include <inttypes.h>
#include <stdlib.h>
#include <zlib.h>

#include "base/error.h"
#include "figure/drawing.h"
#include "figure/font.h"

struct document {
    FILE *out;
    const struct kiln_drawing *drawing;
    long *offsets; /* of objects, from 1 */
    size_t objects;
};

static void begin_object(struct document *document)
{
    document->offsets[++document->objects] = ftell(document->out);
    fprintf(document->out, "%zu 0 obj\n", document->objects);
}

static void put_color(FILE *out, uint32_t color, const char *command)
{
    fprintf(out, "%.4f %.4f %.4f %s\n", (color >> 16) / 255.0, ((color >> 8) & 255) / 255.0,
            (color & 255) / 255.0, command);
}

/* ---- Marks: the page's space is that of the drawing with y up ------------------------------- */

struct pen {
    FILE *out;
    double x, y, scale;
};

static void put_point(const struct pen *pen, double x, double y)
{
    fprintf(pen->out, "%.2f %.2f ", pen->x + x * pen->scale, pen->y + y * pen->scale);
}

static void pen_move(void *user, double x, double y)
{
    const struct pen *pen = user;
    put_point(pen, x, y);
    fputs("m\n", pen->out);
}

static void pen_line(void *user, double x, double y)
{
    const struct pen *pen = user;
    put_point(pen, x, y);
    fputs("l\n", pen->out);
}

static void pen_curve(void *user, const double p[6])
{
    const struct pen *pen = user;
    put_point(pen, p[0], p[1]);
    put_point(pen, p[2], p[3]);
    put_point(pen, p[4], p[5]);
    fputs("c\n", pen->out);
}

static void put_mark(FILE *out, const struct kiln_mark *mark, uint32_t page, size_t *picture)
{
    double scale = (double)mark->height / KILN_FONT_CAPITAL;
    double bottom = (double)page - mark->y - mark->height, half = mark->stroke / 2.0;
    switch (mark->kind) {
    case KILN_MARK_PICTURE:
        fprintf(out, "q %u 0 0 %u %d %.0f cm /P%zu Do Q\n", mark->width, mark->height, mark->x,
                bottom, (*picture)++);
        return;
    case KILN_MARK_FILL:
        put_color(out, mark->color, "rg");
        fprintf(out, "%d %.0f %u %u re f\n", mark->x, bottom, mark->width, mark->height);
        return;
    case KILN_MARK_FRAME:
        put_color(out, mark->color, "RG");
        fprintf(out, "%u w 0 J 0 j %.1f %.1f %.1f %.1f re S\n", mark->stroke, mark->x + half,
                bottom + half, mark->width - 2 * half, mark->height - 2 * half);
        return;
    case KILN_MARK_TEXT:
        put_color(out, mark->color, "RG");
        fprintf(out, "%.3f w 1 J 1 j\n", KILN_FONT_PEN * scale);
        kiln_font_draw(mark->text,
                       &(struct kiln_font_pen){
                           pen_move, pen_line, pen_curve,
                           &(struct pen){out, mark->x, (double)page - mark->y + 0.5, scale}});
        fputs("S\n", out);
    }
}

static bool put_page(struct document *document)
{
    const struct kiln_drawing *drawing = document->drawing;
    char *text = NULL;
    size_t size = 0, picture = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return false;
    fputs("0.75 0 0 0.75 0 0 cm\n", out);
    put_color(out, drawing->paper, "rg");
    fprintf(out, "0 0 %u %u re f\n", drawing->width, drawing->height);
    for (size_t i = 0; i < drawing->count; i++)
        put_mark(out, &drawing->marks[i], drawing->height, &picture);
    bool ok = !ferror(out);
    ok = fclose(out) == 0 && ok;
    begin_object(document);
    fprintf(document->out, "<< /Length %zu >>\nstream\n", size);
    if (ok)
        fwrite(text, 1, size, document->out);
    fputs("\nendstream\nendobj\n", document->out);
    free(text);
    return ok;
}

static bool put_picture(struct document *document, const struct kiln_pixels *pixels)
{
    size_t count = (size_t)pixels->width * pixels->height;
    uLongf size = compressBound((uLong)(count * 3));
    uint8_t *rgb = malloc(count * 3), *packed = malloc(size);
    for (size_t i = 0; rgb && i < count; i++) {
        for (size_t c = 0; c < 3; c++)
            rgb[3 * i + c] = pixels->rgba[4 * i + c];
    }
    bool ok = rgb && packed && compress2(packed, &size, rgb, (uLong)(count * 3), 9) == Z_OK;
    if (ok) {
        begin_object(document);
        fprintf(document->out,
                "<< /Type /XObject /Subtype /Image /Width %u /Height %u /ColorSpace /DeviceRGB "
                "/BitsPerComponent 8 /Interpolate false /Filter /FlateDecode /Length %lu >>\n"
                "stream\n",
                pixels->width, pixels->height, size);
        fwrite(packed, 1, size, document->out);
        fputs("\nendstream\nendobj\n", document->out);
    }
    free(rgb);
    free(packed);
    return ok;
}

/* Objects: 1 catalogue, 2 pages, 3 the page, 4 what is on it, then the pictures. */
static bool put_objects(struct document *document)
{
    const struct kiln_drawing *drawing = document->drawing;
    FILE *out = document->out;
    fputs("%PDF-1.4\n%\xe2\xe3\xcf\xd3\n", out);
    begin_object(document);
    fputs("<< /Type /Catalog /Pages 2 0 R >>\nendobj\n", out);
    begin_object(document);
    fputs("<< /Type /Pages /Kids [3 0 R] /Count 1 >>\nendobj\n", out);
    begin_object(document);
    fprintf(out,
            "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 %.2f %.2f] /Contents 4 0 R\n"
            "/Resources << /XObject <<",
            drawing->width * 0.75, drawing->height * 0.75);
    size_t pictures = 0;
    for (size_t i = 0; i < drawing->count; i++) {
        if (drawing->marks[i].kind == KILN_MARK_PICTURE) {
            fprintf(out, " /P%zu %zu 0 R", pictures, 5 + pictures);
            pictures++;
        }
    }
    fputs(" >> >> >>\nendobj\n", out);
    bool ok = put_page(document);
    for (size_t i = 0; ok && i < drawing->count; i++) {
        if (drawing->marks[i].kind == KILN_MARK_PICTURE)
            ok = put_picture(document, &drawing->marks[i].pixels);
    }
    return ok;
}

static void put_table(const struct document *document)
{
    long start = ftell(document->out);
    fprintf(document->out, "xref\n0 %zu\n0000000000 65535 f \n", document->objects + 1);
    for (size_t i = 1; i <= document->objects; i++)
        fprintf(document->out, "%010ld 00000 n \n", document->offsets[i]);
    fprintf(document->out, "trailer\n<< /Size %zu /Root 1 0 R >>\nstartxref\n%ld\n%%%%EOF\n",
            document->objects + 1, start);
}

bool kiln_drawing_pdf(const struct kiln_drawing *drawing, uint8_t **bytes, size_t *size,
                      struct kiln_error *error)
{
    char *text = NULL;
    struct document document = {.drawing = drawing,
                                .out = open_memstream(&text, size),
                                .offsets = calloc(drawing->count + 8, sizeof(long))};
    bool ok = document.out && document.offsets && put_objects(&document);
    if (ok)
        put_table(&document);
    if (document.out) {
        ok = !ferror(document.out) && ok;
        ok = fclose(document.out) == 0 && ok;
    }
    free(document.offsets);
    *bytes = ok ? (uint8_t *)text : NULL;
    if (ok)
        return true;
    free(text);
    return kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for a PDF document");
}
