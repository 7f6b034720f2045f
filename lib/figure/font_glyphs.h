/* Declares the tables of the lettering, each ascending by code. */
#ifndef KILN_FIGURE_FONT_GLYPHS_H
#define KILN_FIGURE_FONT_GLYPHS_H

#include <stdbool.h>
#include <stdint.h>

struct kiln_glyph {
    uint32_t code;    /* of Unicode */
    uint16_t advance; /* to the next glyph's origin */
    /* Commands of a letter and whole numbers: M x y starts a stroke, L goes straight to a point, H
     * and V go there by a quarter of an ellipse that leaves horizontally or vertically, C by a
     * Bezier curve of two more points; D x y is a dot; U x y percent CHARACTER draws the glyph of
     * an ASCII character, scaled, from that point. */
    const char *path;
};
extern const struct kiln_glyph kiln_font_glyphs[];
extern const uint32_t kiln_font_glyph_count;

/* A mark that is drawn over or under a letter, around x = 0. */
struct kiln_font_mark {
    uint32_t code; /* of Unicode's combining character */
    bool rises;    /* is drawn higher over tall letters */
    uint8_t half;  /* half of the width that the mark needs */
    const char *path;
};
extern const struct kiln_font_mark kiln_font_marks[];
extern const uint32_t kiln_font_mark_count;

/* A letter that is drawn as the glyph of another one, with a mark or without. */
struct kiln_font_letter {
    uint16_t code, base;
    uint16_t mark; /* 0: none */
    int8_t x;      /* of the mark, from the middle of the base */
    int8_t room;   /* more room: before the base if negative, else behind it */
};
extern const struct kiln_font_letter kiln_font_letters[];
extern const uint32_t kiln_font_letter_count;

#endif
