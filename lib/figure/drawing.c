/* Lists of marks. */
#include "figure/drawing.h"

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

uint32_t kiln_drawing_text_width(const char *text, uint32_t height)
{
    return (uint32_t)(((uint64_t)kiln_font_width(text) * height + KILN_FONT_CAPITAL - 1) /
                      KILN_FONT_CAPITAL);
}
