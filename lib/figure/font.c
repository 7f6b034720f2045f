/* Walks the paths of glyphs. */
#include "figure/font.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "figure/font_glyphs.h"

/* Between glyphs, beside the room that each has: lettering in figures is small. */
enum { SPACING = 4 };

static const struct kiln_glyph missing = {0, 72, "M12 0 L12 100 L60 100 L60 0 L12 0"};

/* How far the control points of a quarter of an ellipse are along its tangents: a little beyond
 * that of a circle, which looks rounder in letters. */
static const double ROUND = 0.58;

static const struct kiln_glyph *find(uint32_t code)
{
    uint32_t low = 0, high = kiln_font_glyph_count;
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (kiln_font_glyphs[middle].code < code)
            low = middle + 1;
        else
            high = middle;
    }
    bool found = low < kiln_font_glyph_count && kiln_font_glyphs[low].code == code;
    return found ? &kiln_font_glyphs[low] : NULL;
}

const struct kiln_glyph *kiln_font_glyph(uint32_t code)
{
    const struct kiln_glyph *glyph = find(code);
    return glyph ? glyph : &missing;
}

bool kiln_font_has(uint32_t code)
{
    return find(code) != NULL;
}

uint32_t kiln_font_next(const char **text)
{
    const unsigned char *bytes = (const unsigned char *)*text;
    if (!*bytes)
        return 0;
    size_t length = kiln_text_utf8_length(*text);
    *text += length ? length : 1;
    switch (length) {
    case 1:
        return bytes[0];
    case 2:
        return (bytes[0] & 0x1fu) << 6 | (bytes[1] & 0x3fu);
    case 3:
        return (bytes[0] & 0x0fu) << 12 | (bytes[1] & 0x3fu) << 6 | (bytes[2] & 0x3fu);
    case 4:
        return (bytes[0] & 0x07u) << 18 | (bytes[1] & 0x3fu) << 12 | (bytes[2] & 0x3fu) << 6 |
               (bytes[3] & 0x3fu);
    default:
        return 0xFFFD;
    }
}

uint32_t kiln_font_width(const char *text)
{
    uint32_t width = 0, code;
    while ((code = kiln_font_next(&text)) != 0)
        width += kiln_font_glyph(code)->advance + SPACING;
    return width;
}

struct walk {
    const struct kiln_font_pen *pen;
    double origin, x, y; /* of the glyph, and where the pen is in it */
};

static void move_to(struct walk *walk, double x, double y)
{
    walk->x = x;
    walk->y = y;
    walk->pen->move(walk->pen->user, walk->origin + x, y);
}

static void line_to(struct walk *walk, double x, double y)
{
    walk->x = x;
    walk->y = y;
    walk->pen->line(walk->pen->user, walk->origin + x, y);
}

static void curve_to(struct walk *walk, double ax, double ay, double bx, double by, double x,
                     double y)
{
    double o = walk->origin;
    walk->x = x;
    walk->y = y;
    walk->pen->curve(walk->pen->user, (const double[6]){o + ax, ay, o + bx, by, o + x, y});
}

static void quarter_to(struct walk *walk, bool leaves_horizontally, double x, double y)
{
    double dx = x - walk->x, dy = y - walk->y;
    if (leaves_horizontally)
        curve_to(walk, walk->x + ROUND * dx, walk->y, x, y - ROUND * dy, x, y);
    else
        curve_to(walk, walk->x, walk->y + ROUND * dy, x - ROUND * dx, y, x, y);
}

/* Its strokes cover it, whatever the pen. */
static void dot(struct walk *walk, double x, double y)
{
    move_to(walk, x - 2, y);
    line_to(walk, x, y + 2);
    line_to(walk, x + 2, y);
    line_to(walk, x, y - 2);
    line_to(walk, x - 2, y);
}

static void walk_path(struct walk *walk, const char *path)
{
    while (*path) {
        char command = *path++;
        double n[6] = {0};
        int count = command == 'C' ? 6 : 2;
        for (int i = 0; i < count; i++) {
            char *end;
            n[i] = (double)strtol(path, &end, 10);
            path = end;
        }
        path += strspn(path, " ");
        if (command == 'M')
            move_to(walk, n[0], n[1]);
        else if (command == 'L')
            line_to(walk, n[0], n[1]);
        else if (command == 'C')
            curve_to(walk, n[0], n[1], n[2], n[3], n[4], n[5]);
        else if (command == 'D')
            dot(walk, n[0], n[1]);
        else
            quarter_to(walk, command == 'H', n[0], n[1]);
    }
}

void kiln_font_draw(const char *text, const struct kiln_font_pen *pen)
{
    struct walk walk = {.pen = pen};
    uint32_t code;
    while ((code = kiln_font_next(&text)) != 0) {
        const struct kiln_glyph *glyph = kiln_font_glyph(code);
        walk_path(&walk, glyph->path);
        walk.origin += glyph->advance + SPACING;
    }
}
