/* Reads lengths on the command line by a table of their units. */
#include "length.h"

#include <math.h>
#include <string.h>

static const struct {
    const char *name;
    double mm; /* 0: pixels */
} units[] = {{"mm", 1}, {"cm", 10}, {"in", 25.4}, {"pt", 25.4 / 72}, {"px", 0}, {"", 0}};

bool length_read(const char *text, struct length *length)
{
    char digits[40] = "";
    size_t count = strcspn(text, "cimp");
    if (count == 0 || count >= sizeof digits)
        return false;
    memcpy(digits, text, count);
    if (!kiln_text_to_double(digits, &length->value))
        return false;
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (strcmp(text + count, units[i].name) != 0)
            continue;
        length->on_paper = units[i].mm > 0;
        if (length->on_paper)
            length->value *= units[i].mm;
        return length->value > 0 && length->value < 1e6 &&
               (length->on_paper || length->value == floor(length->value));
    }
    return false;
}
