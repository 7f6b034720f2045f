/* Writes a drawing as PDF 1.4 of one page. Pictures are deflated RGB. Text is drawn as strokes;
 * over them lies the same text, invisible, which readers select and search. A figure with a text
 * for screen readers is a tagged document of one element. The file holds neither the time nor
 * anything about the machine. */
#include "figure/pdf.h"

#include <inttypes.h>
#include <stdlib.h>
#include <zlib.h>

#include "base/error.h"
#include "figure/font.h"

void kiln_pdf_begin(struct kiln_pdf *pdf)
{
    pdf->offsets[++pdf->objects] = ftell(pdf->out);
    fprintf(pdf->out, "%zu 0 obj\n", pdf->objects);
}

bool kiln_pdf_stream(struct kiln_pdf *pdf, const char *entries, const void *bytes, size_t size)
{
    uLongf packed_size = compressBound((uLong)size);
    uint8_t *packed = malloc(packed_size);
    bool ok = packed && compress2(packed, &packed_size, bytes, (uLong)size, 9) == Z_OK;
    if (ok) {
        kiln_pdf_begin(pdf);
        fprintf(pdf->out, "<< %s/Filter /FlateDecode /Length %lu >>\nstream\n", entries,
                packed_size);
        fwrite(packed, 1, packed_size, pdf->out);
        fputs("\nendstream\nendobj\n", pdf->out);
    }
    free(packed);
    return ok;
}

/* Writes the next character of a text as UTF-16 in hexadecimal digits; false at its end. */
static bool put_utf16(FILE *out, const char **text)
{
    uint32_t code = kiln_font_next(text);
    if (code >= 0x10000)
        fprintf(out, "%04X%04X", 0xD800 + ((code - 0x10000) >> 10), 0xDC00 + (code & 0x3FF));
    else if (code != 0)
        fprintf(out, "%04X", code);
    return code != 0;
}

/* Writes a text of the document that is not shown on the page, such as its title, as UTF-16. */
static void put_string(FILE *out, const char *text)
{
    fputs("<FEFF", out);
    while (put_utf16(out, &text))
        continue;
    fputs(">", out);
}

static double points_per_pixel(const struct kiln_drawing *drawing)
{
    return drawing->pixel_mm > 0 ? drawing->pixel_mm * 72 / 25.4 : 0.75;
}

static void put_color(FILE *out, uint32_t color, const char *command)
{
    fprintf(out, "%.4f %.4f %.4f %s\n", (color >> 16) / 255.0, ((color >> 8) & 255) / 255.0,
            (color & 255) / 255.0, command);
}

/* ---- Marks: the page's coordinates are the drawing's with y up ------------------------------ */

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

/* Draws a text as strokes, and then as text in a font without outlines and in the invisible text
 * rendering mode (3 Tr). */
static void put_text(FILE *out, const struct kiln_mark *mark, double baseline)
{
    double scale = mark->capital / KILN_FONT_CAPITAL;
    put_color(out, mark->color, "RG");
    fprintf(out, "%.3f w 1 J 1 j\n", KILN_FONT_PEN * scale);
    kiln_font_draw(mark->text,
                   &(struct kiln_font_pen){pen_move, pen_line, pen_curve,
                                           &(struct pen){out, mark->x, baseline + 0.5, scale}});
    fprintf(out, "S\nBT 3 Tr %.3f 0 0 %.3f %d %.1f Tm ", kiln_drawing_font_size(mark->capital),
            kiln_drawing_font_size(mark->capital), mark->x, baseline + 0.5);
    fputs("/F 1 Tf <", out);
    const char *text = mark->text;
    while (put_utf16(out, &text))
        continue;
    fputs("> Tj ET\n", out);
}

static void put_mark(FILE *out, const struct kiln_mark *mark, uint32_t page, size_t *picture)
{
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
        put_text(out, mark, (double)page - mark->y);
    }
}

/* ---- Objects -------------------------------------------------------------------------------- */

/* Numbers of objects. The catalogue, the page tree, the page, its content and the pictures come
 * first. The font and the other objects of struct numbers follow; a 0 says that the figure does not
 * have the object. */
enum { CATALOGUE = 1, PAGES, PAGE, CONTENT, PICTURES };
struct numbers {
    size_t pictures; /* the number of pictures */
    size_t font, info, tree, element;
};

static struct numbers number_objects(const struct kiln_drawing *drawing)
{
    struct numbers numbers = {0};
    bool lettered = false;
    for (size_t i = 0; i < drawing->count; i++) {
        numbers.pictures += drawing->marks[i].kind == KILN_MARK_PICTURE;
        lettered = lettered || drawing->marks[i].kind == KILN_MARK_TEXT;
    }
    size_t next = PICTURES + numbers.pictures;
    if (lettered) {
        numbers.font = next;
        next += KILN_PDF_FONT_OBJECTS;
    }
    if (drawing->title)
        numbers.info = next++;
    if (drawing->alt) {
        numbers.tree = next++;
        numbers.element = next++;
    }
    return numbers;
}

static bool put_content(struct kiln_pdf *pdf)
{
    const struct kiln_drawing *drawing = pdf->drawing;
    char *text = NULL;
    size_t size = 0, picture = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return false;
    double scale = points_per_pixel(drawing);
    if (drawing->alt)
        fputs("/Figure << /MCID 0 >> BDC\n", out);
    fprintf(out, "%.8g 0 0 %.8g 0 0 cm\n", scale, scale);
    put_color(out, drawing->paper, "rg");
    fprintf(out, "0 0 %u %u re f\n", drawing->width, drawing->height);
    for (size_t i = 0; i < drawing->count; i++)
        put_mark(out, &drawing->marks[i], drawing->height, &picture);
    if (drawing->alt)
        fputs("EMC\n", out);
    bool ok = !ferror(out);
    ok = fclose(out) == 0 && ok && kiln_pdf_stream(pdf, "", text, size);
    free(text);
    return ok;
}

static bool put_picture(struct kiln_pdf *pdf, const struct kiln_pixels *pixels)
{
    size_t count = (size_t)pixels->width * pixels->height;
    uint8_t *rgb = malloc(count * 3);
    for (size_t i = 0; rgb && i < count; i++) {
        for (size_t c = 0; c < 3; c++)
            rgb[3 * i + c] = pixels->rgba[4 * i + c];
    }
    char entries[200];
    snprintf(entries, sizeof entries,
             "/Type /XObject /Subtype /Image /Width %u /Height %u /ColorSpace /DeviceRGB "
             "/BitsPerComponent 8 /Interpolate false ",
             pixels->width, pixels->height);
    bool ok = rgb && kiln_pdf_stream(pdf, entries, rgb, count * 3);
    free(rgb);
    return ok;
}

static void put_catalogue(struct kiln_pdf *pdf, const struct numbers *numbers)
{
    FILE *out = pdf->out;
    kiln_pdf_begin(pdf);
    fprintf(out, "<< /Type /Catalog /Pages %d 0 R", (int)PAGES);
    if (numbers->info)
        fputs("\n/ViewerPreferences << /DisplayDocTitle true >>", out);
    if (numbers->tree)
        fprintf(out, "\n/MarkInfo << /Marked true >> /StructTreeRoot %zu 0 R", numbers->tree);
    fputs(" >>\nendobj\n", out);
    kiln_pdf_begin(pdf);
    fprintf(out, "<< /Type /Pages /Kids [%d 0 R] /Count 1 >>\nendobj\n", (int)PAGE);
}

static void put_page(struct kiln_pdf *pdf, const struct numbers *numbers)
{
    const struct kiln_drawing *drawing = pdf->drawing;
    FILE *out = pdf->out;
    double scale = points_per_pixel(drawing);
    kiln_pdf_begin(pdf);
    fprintf(out, "<< /Type /Page /Parent %d 0 R /MediaBox [0 0 %.3f %.3f] /Contents %d 0 R\n",
            (int)PAGES, drawing->width * scale, drawing->height * scale, (int)CONTENT);
    if (numbers->tree)
        fputs("/StructParents 0 ", out);
    fputs("/Resources << /XObject <<", out);
    for (size_t i = 0; i < numbers->pictures; i++)
        fprintf(out, " /P%zu %zu 0 R", i, PICTURES + i);
    fputs(" >>", out);
    if (numbers->font)
        fprintf(out, " /Font << /F %zu 0 R >>", numbers->font);
    fputs(" >> >>\nendobj\n", out);
}

/* Writes the structure tree, whose only element is the figure. */
static void put_structure(struct kiln_pdf *pdf, const struct numbers *numbers)
{
    const struct kiln_drawing *drawing = pdf->drawing;
    double scale = points_per_pixel(drawing);
    FILE *out = pdf->out;
    kiln_pdf_begin(pdf);
    fprintf(out,
            "<< /Type /StructTreeRoot /K %zu 0 R /ParentTreeNextKey 1\n"
            "/ParentTree << /Nums [0 [%zu 0 R]] >> >>\nendobj\n",
            numbers->element, numbers->element);
    kiln_pdf_begin(pdf);
    fprintf(out, "<< /Type /StructElem /S /Figure /P %zu 0 R /Pg %d 0 R /K 0\n/Alt ", numbers->tree,
            (int)PAGE);
    put_string(out, drawing->alt);
    fprintf(out, "\n/A << /O /Layout /BBox [0 0 %.3f %.3f] >> >>\nendobj\n", drawing->width * scale,
            drawing->height * scale);
}

static bool put_objects(struct kiln_pdf *pdf, const struct numbers *numbers)
{
    const struct kiln_drawing *drawing = pdf->drawing;
    fputs("%PDF-1.4\n%\xe2\xe3\xcf\xd3\n", pdf->out);
    put_catalogue(pdf, numbers);
    put_page(pdf, numbers);
    bool ok = put_content(pdf);
    for (size_t i = 0; ok && i < drawing->count; i++) {
        if (drawing->marks[i].kind == KILN_MARK_PICTURE)
            ok = put_picture(pdf, &drawing->marks[i].pixels);
    }
    ok = ok && (!numbers->font || kiln_pdf_font(pdf));
    if (ok && numbers->info) {
        kiln_pdf_begin(pdf);
        fputs("<< /Title ", pdf->out);
        put_string(pdf->out, drawing->title);
        fputs(" >>\nendobj\n", pdf->out);
    }
    if (ok && numbers->tree)
        put_structure(pdf, numbers);
    return ok;
}

static void put_table(const struct kiln_pdf *pdf, const struct numbers *numbers)
{
    long start = ftell(pdf->out);
    fprintf(pdf->out, "xref\n0 %zu\n0000000000 65535 f \n", pdf->objects + 1);
    for (size_t i = 1; i <= pdf->objects; i++)
        fprintf(pdf->out, "%010ld 00000 n \n", pdf->offsets[i]);
    fprintf(pdf->out, "trailer\n<< /Size %zu /Root %d 0 R", pdf->objects + 1, (int)CATALOGUE);
    if (numbers->info)
        fprintf(pdf->out, " /Info %zu 0 R", numbers->info);
    fprintf(pdf->out, " >>\nstartxref\n%ld\n%%%%EOF\n", start);
}

bool kiln_drawing_pdf(const struct kiln_drawing *drawing, uint8_t **bytes, size_t *size,
                      struct kiln_error *error)
{
    enum { MOST_OTHERS = 16 };
    char *text = NULL;
    struct numbers numbers = number_objects(drawing);
    struct kiln_pdf pdf = {.drawing = drawing,
                           .out = open_memstream(&text, size),
                           .offsets = calloc(numbers.pictures + MOST_OTHERS, sizeof(long))};
    bool ok = pdf.out && pdf.offsets && put_objects(&pdf, &numbers);
    if (ok)
        put_table(&pdf, &numbers);
    if (pdf.out) {
        ok = !ferror(pdf.out) && ok;
        ok = fclose(pdf.out) == 0 && ok;
    }
    free(pdf.offsets);
    *bytes = ok ? (uint8_t *)text : NULL;
    if (ok)
        return true;
    free(text);
    return kiln_error_no_memory(error, "a PDF document");
}
