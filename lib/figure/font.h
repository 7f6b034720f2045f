/* Draws text with kiln's own stroke font. A glyph is a path drawn with a round pen, so text has any
 * size, and looks the same in pixels and in vectors. The font has Latin-1, Latin Extended-A, Greek,
 * dashes, quotes and mathematics (font_glyphs.c, font_letters.c). Units: capitals are 100 high,
 * small letters 70; the baseline is y = 0, and y goes up. */
#ifndef KILN_FIGURE_FONT_H
#define KILN_FIGURE_FONT_H

#include <stdbool.h>
#include <stdint.h>

enum {
    KILN_FONT_EM = 140, /* the font size, roughly */
    KILN_FONT_CAPITAL = 100,
    KILN_FONT_ASCENT = 146, /* height of a capital with an accent, pen included */
    KILN_FONT_DESCENT = 40, /* depth below the baseline, pen included */
    KILN_FONT_PEN = 12
};

/* Returns whether the font has a glyph for a character. */
bool kiln_font_has(uint32_t code);

/* Returns the place of the first character of a text that has no glyph, and sets its code (U+FFFD
 * for a byte that is no UTF-8). NULL when all characters have glyphs. */
const char *kiln_font_missing(const char *text, uint32_t *code);

/* Returns the advance width of a character; 0 for a combining mark. A character without a glyph is
 * drawn as a box. */
uint32_t kiln_font_advance(uint32_t code);

/* Returns the next character of a UTF-8 text, and moves the text on; U+FFFD for a byte that is no
 * UTF-8, 0 at the end. */
uint32_t kiln_font_next(const char **text);

/* Returns the width of a text, in font units. */
uint32_t kiln_font_width(const char *text);

/* Callbacks that receive a text's strokes from kiln_font_draw, in font units from its origin. */
struct kiln_font_pen {
    void (*move)(void *user, double x, double y);
    void (*line)(void *user, double x, double y);
    void (*curve)(void *user, const double points[6]); /* two control points, and the end */
    void *user;
};
void kiln_font_draw(const char *text, const struct kiln_font_pen *pen);

#endif
