/* Declares what pdf.c and pdf_font.c share: the file, and where its objects start. */
#ifndef KILN_FIGURE_PDF_H
#define KILN_FIGURE_PDF_H

#include "figure/drawing.h"

struct kiln_pdf {
    FILE *out;
    const struct kiln_drawing *drawing;
    long *offsets; /* the objects' offsets in the file, from index 1; the caller has made room */
    size_t objects;
};

/* Starts the next object; the caller writes it, and "endobj". */
void kiln_pdf_begin(struct kiln_pdf *pdf);

/* Writes an object that is a deflated stream. `entries` are the entries of its dictionary beside
 * the length and the filter. False when memory is short. */
bool kiln_pdf_stream(struct kiln_pdf *pdf, const char *entries, const void *bytes, size_t size);

/* The number of objects of a font without outlines, which is for invisible text that readers select
 * and search. It has the width and the code of every character of the drawing. The font is
 * embedded, since printers and publishers want all fonts embedded. */
enum { KILN_PDF_FONT_OBJECTS = 6 };

/* Writes the font's objects, of which the first is the font. False when memory is short. */
bool kiln_pdf_font(struct kiln_pdf *pdf);

#endif
