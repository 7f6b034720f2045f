/* Declares the tables of the stroke font, each sorted by code. */
#ifndef KILN_FIGURE_FONT_GLYPHS_H
#define KILN_FIGURE_FONT_GLYPHS_H

#include <stdbool.h>
#include <stdint.h>

struct kiln_glyph {
    uint32_t code;    /* Unicode code point */
    uint16_t advance; /* from the glyph's origin to the next glyph's */
    /* Commands, each a letter with whole numbers: M x y starts a stroke; L x y draws a straight
     * line; H x y and V x y draw a quarter of an ellipse that leaves horizontally or vertically; C
     * draws a Bezier curve with two control points before its end; D x y draws a dot; U x y percent
     * CHARACTER draws the glyph of an ASCII character, scaled, with its origin at that point. */
    const char *path;
};
extern const struct kiln_glyph kiln_font_glyphs[];
extern const uint32_t kiln_font_glyph_count;

/* A diacritical mark, drawn over or under a letter and centred at x = 0. */
struct kiln_font_mark {
    uint32_t code; /* Unicode's code point, mostly of a combining character */
    bool rises;    /* stands higher over tall letters */
    uint8_t half;  /* half of the width that the mark needs */
    const char *path;
};
extern const struct kiln_font_mark kiln_font_marks[];
extern const uint32_t kiln_font_mark_count;

/* A letter that is drawn as the glyph of another letter, with a mark or without. */
struct kiln_font_letter {
    uint16_t code, base;
    uint16_t mark; /* 0: none */
    int8_t x;      /* position of the mark, from the middle of the base */
    int8_t room;   /* extra space: before the base if negative, else behind it */
};
extern const struct kiln_font_letter kiln_font_letters[];
extern const uint32_t kiln_font_letter_count;

#endif
