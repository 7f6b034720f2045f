/* Declares what the writers of a PDF share: the file and where its objects start. */
#ifndef KILN_FIGURE_PDF_H
#define KILN_FIGURE_PDF_H

#include "figure/drawing.h"

struct kiln_pdf {
    FILE *out;
    const struct kiln_drawing *drawing;
    long *offsets; /* of objects, from 1; the caller has made room */
    size_t objects;
};

/* Starts the next object; the caller writes it, and "endobj". */
void kiln_pdf_begin(struct kiln_pdf *pdf);

/* Writes an object that is a deflated stream; `entries` are those of its dictionary beside the
 * length and the filter. False when memory is short. */
bool kiln_pdf_stream(struct kiln_pdf *pdf, const char *entries, const void *bytes, size_t size);

/* The number of objects of a font without outlines, for text that is selected and searched and not
 * seen: every character of the drawing has its width and its code. The font is embedded, as
 * printers and publishers want all fonts. */
enum { KILN_PDF_FONT_OBJECTS = 6 };

/* Writes the font's objects, of which the first is the font. False when memory is short. */
bool kiln_pdf_font(struct kiln_pdf *pdf);

#endif
