/* Defines the macros for the rows of option tables. A file defines AT(field) before the rows of a
 * table as the offset of a field in the table's struct. Only files with tables include this
 * header. */
#ifndef KILN_OPTION_ROWS_H
#define KILN_OPTION_ROWS_H

#include "option/option.h"

#define TIME KILN_ALLOW_TIME
#define BOTH KILN_ALLOW_BOTH

#define ROW(part_, name_, type_, offset_, fallback_, help_)                                        \
    .name = name_, .type = &kiln_type_##type_, .offset = offset_, .fallback = fallback_,           \
    .help = help_, .parts = part_
#define LIMITS(dimension_, min_, max_) .dimension = dimension_, .min = min_, .max = max_

/* The value of `parts` in struct kiln_option for rows of files that have no parts. `parts` is the
 * first parameter of each row macro. */
#define NO_PART NULL

/* further parameters: name, field, dimension, smallest, largest, clocks, default, help */
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
/* further parameters: name, field, largest, clocks, default, help */
#define COLOR(part, n, f, hi, when, def, h)                                                        \
    {                                                                                              \
        ROW(part, n, color, AT(f), def, h), LIMITS(KILN_PLAIN, 0, hi), .clocks = when              \
    }
/* further parameters: name, field, smallest, largest, default, help */
#define INTEGER(part, n, f, lo, hi, def, h)                                                        \
    {                                                                                              \
        ROW(part, n, integer, AT(f), def, h), LIMITS(KILN_PLAIN, lo, hi)                           \
    }
/* further parameters: name, field, default, help */
#define BOOLEAN(part, n, f, def, h)                                                                \
    {                                                                                              \
        ROW(part, n, boolean, AT(f), def, h)                                                       \
    }
/* further parameters: name, field, words, default, help */
#define CHOICE(part, n, f, words, def, h)                                                          \
    {                                                                                              \
        ROW(part, n, choice, AT(f), def, h), .choices = words                                      \
    }
/* further parameters: name, offset, members, help; each member has a default or is itself
 * required */
#define GROUP(part, n, at, rows, h)                                                                \
    {                                                                                              \
        ROW(part, n, group, at, "{}", h), .members = rows                                          \
    }
#define END                                                                                        \
    {                                                                                              \
        .name = NULL                                                                               \
    }

#endif
