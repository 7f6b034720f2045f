/* Finds rows of an option table by name and describes them for messages and documents. */
#include "option/option.h"

#include <stdio.h>
#include <string.h>

const struct kiln_option *kiln_option_find(const struct kiln_option *table, const char *name)
{
    for (; table->name; table++) {
        if (strcmp(table->name, name) == 0)
            return table;
    }
    return NULL;
}

void kiln_option_suggest(char *out, size_t size, const char *name, const char *const *names,
                         size_t count)
{
    const char *nearest = kiln_text_nearest(name, names, count);
    if (nearest) {
        snprintf(out, size, " (did you mean '%s'?)", nearest);
        return;
    }
    size_t length = (size_t)snprintf(out, size, count ? " (there are: " : " (there are none)");
    for (size_t i = 0; i < count && length < size; i++)
        length += (size_t)snprintf(out + length, size - length, "%s%s", i ? ", " : "", names[i]);
    if (count && length < size)
        snprintf(out + length, size - length, ")");
}

const char *kiln_option_clocks(const struct kiln_option *option)
{
    switch (option->clocks) {
    case KILN_OVER_TIME:
        return "over time";
    case KILN_AT_BIRTH:
        return "over time or at random";
    case KILN_OVER_LIFE:
        return "over every clock but distance";
    case KILN_WHEN_DRAWN:
        return "over every clock";
    case KILN_SUMMED_UP:
        return "over time, over life or at random";
    default:
        return NULL;
    }
}

void kiln_option_describe_limits(const struct kiln_option *option, struct kiln_text *out)
{
    char min[48], max[48];
    kiln_unit_print_double(min, option->dimension, option->min);
    kiln_unit_print_double(max, option->dimension, option->max);
    if (option->min == option->max)
        kiln_text_add(out, " %s", min);
    else
        kiln_text_add(out, " from %s to %s", min, max);
}
