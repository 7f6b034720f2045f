/* Letters figures by a stroke font of kiln's own. A glyph is a path drawn with a round pen, so it
 * has any size, and looks the same in pixels and in vectors. The font has Latin-1, Latin
 * Extended-A, Greek, dashes, quotes and mathematics (font_glyphs.c, font_letters.c). Units: 100 is
 * the height of a capital, 70 of a small letter, the baseline is 0 and y goes up. */
#ifndef KILN_FIGURE_FONT_H
#define KILN_FIGURE_FONT_H

#include <stdbool.h>
#include <stdint.h>

enum {
    KILN_FONT_EM = 140, /* roughly the size of the font */
    KILN_FONT_CAPITAL = 100,
    KILN_FONT_ASCENT = 146, /* of a capital with an accent */
    KILN_FONT_DESCENT = 40, /* both with the pen */
    KILN_FONT_PEN = 12
};

/* Whether there is a glyph for a character. */
bool kiln_font_has(uint32_t code);

/* Finds the first character of a text that has no glyph, and its code (U+FFFD for a byte that is no
 * UTF-8); NULL when all have one. */
const char *kiln_font_missing(const char *text, uint32_t *code);

/* Returns how far a character moves the pen; 0 for a mark that joins the letter before it. A
 * character without a glyph is drawn as a box. */
uint32_t kiln_font_advance(uint32_t code);

/* Returns the next character of a UTF-8 text, and moves the text on; U+FFFD for a byte that is no
 * UTF-8, 0 at the end. */
uint32_t kiln_font_next(const char **text);

/* The width of a text, in units. */
uint32_t kiln_font_width(const char *text);

/* Callbacks that kiln_font_draw tells of a text's strokes, in units from its origin. */
struct kiln_font_pen {
    void (*move)(void *user, double x, double y);
    void (*line)(void *user, double x, double y);
    void (*curve)(void *user, const double points[6]); /* two control points, and the end */
    void *user;
};
void kiln_font_draw(const char *text, const struct kiln_font_pen *pen);

#endif
