/* Turns texts into strokes: decodes UTF-8, looks up glyphs, puts diacritical marks onto letters,
 * and draws the paths of glyphs with the caller's pen. */
#include "figure/font.h"

#include <ctype.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "figure/font_glyphs.h"

enum {
    SPACING = 4, /* added to each advance, since small lettering needs more room between glyphs */
    RISE = 30,   /* how much higher marks stand over tall letters */
    DOTLESS_I = 0x131,
    DOTLESS_J = 0x237,
};

/* The distance of the control points of a quarter of an ellipse along its tangents. It is a little
 * more than the 0.552 of a circle, which looks rounder in letters. */
static const double ROUND = 0.58;

/* ---- Tables --------------------------------------------------------------------------------- */

static const struct kiln_glyph missing = {0, 72, "M12 0 L12 100 L60 100 L60 0 L12 0"};

/* Returns the row with the code `key`, or NULL, from a table that is sorted by its rows' member
 * `code`. */
#define FIND(table, count, key)                                                                    \
    do {                                                                                           \
        uint32_t low = 0, high = (count);                                                          \
        while (low < high) {                                                                       \
            uint32_t middle = (low + high) / 2;                                                    \
            if ((table)[middle].code < (key))                                                      \
                low = middle + 1;                                                                  \
            else                                                                                   \
                high = middle;                                                                     \
        }                                                                                          \
        return low < (count) && (table)[low].code == (key) ? &(table)[low] : NULL;                 \
    } while (0)

static const struct kiln_glyph *find_glyph(uint32_t code)
{
    FIND(kiln_font_glyphs, kiln_font_glyph_count, code);
}

static const struct kiln_font_letter *find_letter(uint32_t code)
{
    FIND(kiln_font_letters, kiln_font_letter_count, code);
}

static const struct kiln_font_mark *find_mark(uint32_t code)
{
    FIND(kiln_font_marks, kiln_font_mark_count, code);
}

/* A character as it is drawn. */
struct shape {
    const struct kiln_glyph *glyph;
    const struct kiln_font_mark *mark; /* NULL: none */
    double before;                     /* from the character's origin to the glyph's */
    double mark_x;                     /* from the glyph's origin */
    uint32_t advance;
};

static bool find_shape(uint32_t code, struct shape *shape)
{
    const struct kiln_font_letter *letter = find_letter(code);
    const struct kiln_glyph *glyph = find_glyph(letter ? letter->base : code);
    *shape = (struct shape){.glyph = glyph ? glyph : &missing};
    shape->advance = shape->glyph->advance + SPACING;
    if (letter) {
        shape->mark = find_mark(letter->mark);
        shape->mark_x = shape->glyph->advance / 2.0 + letter->x;
        int extra = shape->mark ? 2 * shape->mark->half - shape->glyph->advance : 0;
        extra = extra > 0 ? extra : 0;
        shape->before = (letter->room < 0 ? -letter->room : 0) + extra / 2;
        shape->advance += (uint32_t)(abs(letter->room) + extra);
    }
    return glyph != NULL;
}

bool kiln_font_has(uint32_t code)
{
    struct shape shape;
    return find_mark(code) || find_shape(code, &shape);
}

uint32_t kiln_font_advance(uint32_t code)
{
    struct shape shape;
    find_shape(code, &shape);
    return find_mark(code) ? 0 : shape.advance;
}

/* ---- Texts ---------------------------------------------------------------------------------- */

uint32_t kiln_font_next(const char **text)
{
    const unsigned char *bytes = (const unsigned char *)*text;
    if (!*bytes)
        return 0;
    size_t length = kiln_text_character_length(*text);
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

const char *kiln_font_missing(const char *text, uint32_t *code)
{
    for (const char *place = text; (*code = kiln_font_next(&text)) != 0; place = text) {
        if (!kiln_font_has(*code))
            return place;
    }
    return NULL;
}

uint32_t kiln_font_width(const char *text)
{
    uint32_t width = 0, code;
    while ((code = kiln_font_next(&text)) != 0)
        width += kiln_font_advance(code);
    return width;
}

/* ---- Strokes -------------------------------------------------------------------------------- */

struct cursor {
    const struct kiln_font_pen *pen;
    double origin_x, origin_y, scale; /* of the glyph in the text */
    double x, y;                      /* the pen's position in the glyph */
};

static double at_x(const struct cursor *cursor, double x)
{
    return cursor->origin_x + x * cursor->scale;
}

static double at_y(const struct cursor *cursor, double y)
{
    return cursor->origin_y + y * cursor->scale;
}

static void move_to(struct cursor *cursor, double x, double y)
{
    cursor->x = x;
    cursor->y = y;
    cursor->pen->move(cursor->pen->user, at_x(cursor, x), at_y(cursor, y));
}

static void line_to(struct cursor *cursor, double x, double y)
{
    cursor->x = x;
    cursor->y = y;
    cursor->pen->line(cursor->pen->user, at_x(cursor, x), at_y(cursor, y));
}

static void curve_to(struct cursor *cursor, double ax, double ay, double bx, double by, double x,
                     double y)
{
    cursor->x = x;
    cursor->y = y;
    cursor->pen->curve(cursor->pen->user,
                       (const double[6]){at_x(cursor, ax), at_y(cursor, ay), at_x(cursor, bx),
                                         at_y(cursor, by), at_x(cursor, x), at_y(cursor, y)});
}

static void quarter_to(struct cursor *cursor, bool leaves_horizontally, double x, double y)
{
    double dx = x - cursor->x, dy = y - cursor->y;
    if (leaves_horizontally)
        curve_to(cursor, cursor->x + ROUND * dx, cursor->y, x, y - ROUND * dy, x, y);
    else
        curve_to(cursor, cursor->x, cursor->y + ROUND * dy, x - ROUND * dx, y, x, y);
}

/* Draws a dot as the outline of a square so small that the pen fills it. */
static void dot(struct cursor *cursor, double x, double y)
{
    move_to(cursor, x - 2, y);
    line_to(cursor, x, y + 2);
    line_to(cursor, x + 2, y);
    line_to(cursor, x, y - 2);
    line_to(cursor, x - 2, y);
}

/* Reads a whole number from a path, and moves the path on behind it. */
static double number(const char **path)
{
    char *end;
    double value = (double)strtol(*path, &end, 10);
    *path = end;
    return value;
}

/* Draws a path up to its end or its next command U, and returns that place. */
static const char *draw_strokes(struct cursor *cursor, const char *path)
{
    while (*path && *path != 'U') {
        char command = *path++;
        double n[6] = {0};
        int count = command == 'C' ? 6 : 2;
        for (int i = 0; i < count; i++)
            n[i] = number(&path);
        path += strspn(path, " ");
        if (command == 'M')
            move_to(cursor, n[0], n[1]);
        else if (command == 'L')
            line_to(cursor, n[0], n[1]);
        else if (command == 'C')
            curve_to(cursor, n[0], n[1], n[2], n[3], n[4], n[5]);
        else if (command == 'D')
            dot(cursor, n[0], n[1]);
        else
            quarter_to(cursor, command == 'H', n[0], n[1]);
    }
    return path;
}

/* Draws a whole path. A glyph that the command U draws has no command U of its own. */
static void draw_path(struct cursor *cursor, const char *path)
{
    while (*(path = draw_strokes(cursor, path))) {
        path++;
        double x = number(&path), y = number(&path), percent = number(&path);
        struct cursor used = {.pen = cursor->pen,
                              .origin_x = at_x(cursor, x),
                              .origin_y = at_y(cursor, y),
                              .scale = percent / 100};
        path += strspn(path, " ");
        draw_strokes(&used, find_glyph((unsigned char)*path++)->path);
        path += strspn(path, " ");
    }
}

/* Returns whether a glyph is so tall that marks over it are raised. */
static bool is_tall(const struct kiln_glyph *glyph)
{
    uint32_t code = glyph->code;
    if (code < 0x80)
        return isupper((int)code) || isdigit((int)code) || strchr("bdfhkl", (int)code);
    return (code >= 0xC0 && code <= 0xDE) || (code >= 0x391 && code <= 0x3A9);
}

static void draw_mark(const struct cursor *cursor, const struct shape *shape)
{
    double rise = shape->mark->rises && is_tall(shape->glyph) ? RISE : 0;
    struct cursor over = {.pen = cursor->pen,
                          .origin_x = at_x(cursor, shape->before + shape->mark_x),
                          .origin_y = rise,
                          .scale = 1};
    draw_path(&over, shape->mark->path);
}

void kiln_font_draw(const char *text, const struct kiln_font_pen *pen)
{
    struct cursor cursor = {.pen = pen, .scale = 1};
    struct shape shape = {.glyph = &missing};
    uint32_t code;
    while ((code = kiln_font_next(&text)) != 0) {
        const char *ahead = text;
        const struct kiln_font_mark *mark = find_mark(code),
                                    *next = find_mark(kiln_font_next(&ahead));
        if (mark) { /* a combining mark is drawn over the letter before it */
            shape.mark = mark;
            shape.mark_x = shape.glyph->advance / 2.0;
            struct cursor back = cursor;
            back.origin_x -= shape.advance;
            draw_mark(&back, &shape);
            continue;
        }
        if (next && next->rises && (code == 'i' || code == 'j'))
            code = code == 'i' ? DOTLESS_I : DOTLESS_J;
        find_shape(code, &shape);
        struct cursor glyph = cursor;
        glyph.origin_x += shape.before;
        draw_path(&glyph, shape.glyph->path);
        if (shape.mark)
            draw_mark(&cursor, &shape);
        cursor.origin_x += shape.advance;
    }
}
