/* The lettering of figures: a stroke font of kiln's own. A glyph is a path drawn with a round pen,
 * so it has any size, and looks the same in pixels and in vectors. Units: 100 is the height of a
 * capital, 70 of a small letter, the baseline is 0 and y goes up.
 */
#ifndef KILN_FIGURE_FONT_H
#define KILN_FIGURE_FONT_H

#include <stdbool.h>
#include <stdint.h>

enum {
    KILN_FONT_CAPITAL = 100,
    KILN_FONT_ASCENT = 112,
    KILN_FONT_DESCENT = 30,
    KILN_FONT_PEN = 12
};

struct kiln_glyph {
    uint32_t code;    /* of Unicode */
    uint16_t advance; /* to the next glyph's origin */
    /* Commands of a letter and whole numbers: M x y starts a stroke, L goes straight to a point, H
     * and V go there by a quarter of an ellipse that leaves horizontally or vertically, C by a
     * Bezier curve of two more points; D x y is a dot. */
    const char *path;
};

/* The glyph of a character; a box for one that the font does not have. */
const struct kiln_glyph *kiln_font_glyph(uint32_t code);
bool kiln_font_has(uint32_t code);

/* The next character of a UTF-8 text, which moves on; U+FFFD for a byte that is none. 0: the end.
 */
uint32_t kiln_font_next(const char **text);

/* The width of a text, in units. */
uint32_t kiln_font_width(const char *text);

/* Told of a text's strokes, in units from its origin. */
struct kiln_font_pen {
    void (*move)(void *user, double x, double y);
    void (*line)(void *user, double x, double y);
    void (*curve)(void *user, const double points[6]); /* two control points, and the end */
    void *user;
};
void kiln_font_draw(const char *text, const struct kiln_font_pen *pen);

#endif
