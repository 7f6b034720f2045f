/* Adds marks to a drawing, and measures its text. */
#include "figure/drawing.h"

#include <math.h>
#include <string.h>

#include "figure/font.h"

void kiln_drawing_add(struct kiln_drawing *drawing, const struct kiln_mark *mark)
{
    if (drawing->count == drawing->capacity) {
        size_t capacity = drawing->capacity ? drawing->capacity * 2 : 64;
        struct kiln_mark *marks = kiln_arena_alloc(drawing->arena, capacity, sizeof *marks);
        if (!marks) {
            drawing->failed = true;
            return;
        }
        if (drawing->count)
            memcpy(marks, drawing->marks, drawing->count * sizeof *marks);
        drawing->marks = marks;
        drawing->capacity = capacity;
    }
    drawing->marks[drawing->count++] = *mark;
}

uint32_t kiln_drawing_text_width(const char *text, double capital)
{
    return (uint32_t)ceil(kiln_font_width(text) * capital / KILN_FONT_CAPITAL);
}

double kiln_drawing_font_size(double capital)
{
    return capital * KILN_FONT_EM / KILN_FONT_CAPITAL;
}
