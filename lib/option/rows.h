/* Defines macros by which the tables write their rows. Before the rows of a table, AT(field) is
 * defined as the offset of a field in its struct. Only files with tables include this header. */
#ifndef KILN_OPTION_ROWS_H
#define KILN_OPTION_ROWS_H

#include "option/option.h"

#define TIME KILN_ALLOW_TIME
#define BOTH KILN_ALLOW_BOTH

#define ROW(part_, name_, type_, offset_, fallback_, help_)                                        \
    .name = name_, .type = &kiln_type_##type_, .offset = offset_, .fallback = fallback_,           \
    .help = help_, .parts = part_
#define LIMITS(dimension_, min_, max_) .dimension = dimension_, .min = min_, .max = max_

/* Stands for `parts` of struct kiln_option in rows of files that have no parts. Each row macro
 * takes `parts` first. */
#define NO_PART NULL

/* name, field, dimension, smallest, largest, clocks, default, help */
#define VALUE(part, n, f, dim, lo, hi, when, def, h)                                               \
    {                                                                                              \
        ROW(part, n, value, AT(f), def, h), LIMITS(dim, lo, hi), .clocks = when                    \
    }
#define VECTOR(part, n, f, dim, lo, hi, when, def, h)                                              \
    {                                                                                              \
        ROW(part, n, vector, AT(f), def, h), LIMITS(dim, lo, hi), .clocks = when                   \
    }
#define RANGE(part, n, f, dim, lo, hi, when, def, h)                                               \
    {                                                                                              \
        ROW(part, n, range, AT(f), def, h), LIMITS(dim, lo, hi), .clocks = when                    \
    }
/* name, field, largest, clocks, default, help */
#define COLOR(part, n, f, hi, when, def, h)                                                        \
    {                                                                                              \
        ROW(part, n, color, AT(f), def, h), LIMITS(KILN_PLAIN, 0, hi), .clocks = when              \
    }
/* name, field, smallest, largest, default, help */
#define INTEGER(part, n, f, lo, hi, def, h)                                                        \
    {                                                                                              \
        ROW(part, n, integer, AT(f), def, h), LIMITS(KILN_PLAIN, lo, hi)                           \
    }
/* name, field, default, help */
#define BOOLEAN(part, n, f, def, h)                                                                \
    {                                                                                              \
        ROW(part, n, boolean, AT(f), def, h)                                                       \
    }
/* name, field, words, default, help */
#define CHOICE(part, n, f, words, def, h)                                                          \
    {                                                                                              \
        ROW(part, n, choice, AT(f), def, h), .choices = words                                      \
    }
/* name, offset, members, help; every member has a default or is required on its own */
#define GROUP(part, n, at, rows, h)                                                                \
    {                                                                                              \
        ROW(part, n, group, at, "{}", h), .members = rows                                          \
    }
#define END                                                                                        \
    {                                                                                              \
        .name = NULL                                                                               \
    }

#endif
