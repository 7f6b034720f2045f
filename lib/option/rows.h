/* Defines the macros for the rows of option tables. Only files with tables include this header.
 *
 * Before a table, a file defines FILLS as the struct that the table fills. A row does not compile
 * if its field has another C type than the row's type of options fills (kiln_fills_NAME, option.h).
 * A row with members does not compile if the table of the members fills another struct than the
 * row's field, or than FILLS where the members are fields of the same struct. */
#ifndef KILN_OPTION_ROWS_H
#define KILN_OPTION_ROWS_H

#include "base/field.h"
#include "option/option.h"

/* How the value of a row may vary: the member `clocks`, and `draws` in the brackets. 0 stands for a
 * constant. */
#define TIME(n)   KILN_OVER_TIME, .draws = n
#define BIRTH(n)  KILN_AT_BIRTH, .draws = n
#define LIFE(n)   KILN_OVER_LIFE, .draws = n
#define DRAWN(n)  KILN_WHEN_DRAWN, .draws = n
#define SUMMED(n) KILN_SUMMED_UP, .draws = n

/* ---- tables ---------------------------------------------------------------------------------- */

/* Begin a table of rows or of kinds: TABLE(name) = {..., END}. The type NAME_fills is the struct
 * that the table fills. PUBLIC_TABLE and PUBLIC_KINDS begin tables that a header declares together
 * with this type. */
#define PUBLIC_TABLE(name_)                                                                        \
    typedef FILLS name_##_fills;                                                                   \
    const struct kiln_option name_[]
#define PUBLIC_KINDS(name_)                                                                        \
    typedef FILLS name_##_fills;                                                                   \
    const struct kiln_option_kind name_[]
#define TABLE(name_)                                                                               \
    typedef FILLS name_##_fills;                                                                   \
    static const struct kiln_option name_[]
#define KINDS(name_)                                                                               \
    typedef FILLS name_##_fills;                                                                   \
    static const struct kiln_option_kind name_[]
#define END                                                                                        \
    {                                                                                              \
        .name = NULL                                                                               \
    }

/* Define the item of a list. ITEM has a type of options, and further members of struct kiln_option.
 * ITEM_OF_ROWS is a mapping, whose keys are the rows of a table. ITEM_OF_KINDS is of one of several
 * kinds, whose number the field gets. The type NAME_fills is the C type of an entry of the list. */
#define ITEM(name_, type_, ...)                                                                    \
    typedef kiln_fills_##type_ name_##_fills;                                                      \
    static const struct kiln_option name_ = {.type = &kiln_type_##type_, __VA_ARGS__}
#define ITEM_OF_ROWS(name_, rows_)                                                                 \
    typedef rows_##_fills name_##_fills;                                                           \
    static const struct kiln_option name_ = {.type = &kiln_type_group, .members = rows_}
#define ITEM_OF_KINDS(name_, kinds_, field_, ...)                                                  \
    typedef kinds_##_fills name_##_fills;                                                          \
    static const struct kiln_option name_ = {.type = &kiln_type_kind,                              \
                                             .kinds = kinds_,                                      \
                                             .kind_offset =                                        \
                                                 OFFSET_IN(kinds_##_fills, field_, choice),        \
                                             __VA_ARGS__}

/* ---- parts of rows --------------------------------------------------------------------------- */

/* Is the offset of a field that a type of options fills. */
#define OFFSET_IN(struct_, field_, type_)                                                          \
    KILN_FIELD_OFFSET(struct_, field_, kiln_fills_##type_,                                         \
                      #field_ " is not of the C type that kiln_type_" #type_ " fills")

/* Is a table of rows or kinds, and does not compile unless the table fills the C type. */
#define FILLING(rows_, c_type)                                                                     \
    ((rows_) + KILN_FIELD_ASSERT(KILN_FIELD_IS((rows_##_fills *)NULL, c_type *),                   \
                                 "the table " #rows_ " fills another struct"))

/* Is the offset of a field that a table of rows fills. */
#define OFFSET_OF_ROWS(field_, rows_)                                                              \
    KILN_FIELD_OFFSET(FILLS, field_, rows_##_fills,                                                \
                      #field_ " is not of the struct that the table " #rows_ " fills")
/* Is the offset of an array whose entries an item, or a table of rows, fills. */
#define OFFSET_OF_ARRAY(field_, item_)                                                             \
    (offsetof(FILLS, field_) +                                                                     \
     KILN_FIELD_ASSERT(KILN_FIELD_IS(&((FILLS *)NULL)->field_, item_##_fills(*)[]),                \
                       #field_ " is not an array of what " #item_ " fills"))

/* Has what all rows have; only the macros below use it, which check the offset. */
#define ROW_AT(part_, name_, type_, offset_, fallback_, help_)                                     \
    .name = name_, .type = &kiln_type_##type_, .offset = offset_, .fallback = fallback_,           \
    .help = help_, .parts = part_
/* part, name, type, field, default, help */
#define ROW(part_, name_, type_, field_, fallback_, help_)                                         \
    ROW_AT(part_, name_, type_, OFFSET_IN(FILLS, field_, type_), fallback_, help_)
/* This row is of a type that fills FILLS itself and chooses the fields. */
#define ROW_OF_ALL(part_, name_, type_, fallback_, help_)                                          \
    ROW_AT(part_, name_, type_,                                                                    \
           KILN_FIELD_ASSERT(KILN_FIELD_IS((FILLS *)NULL, kiln_fills_##type_ *),                   \
                             "kiln_type_" #type_ " fills another struct"),                         \
           fallback_, help_)
#define LIMITS(dimension_, min_, max_) .dimension = dimension_, .min = min_, .max = max_
#define MEMBERS(rows_)                 .members = FILLING(rows_, FILLS)
/* Says which field counts the entries of an array, and that a file may have as many as fit. */
#define COUNTED(array_, count_)                                                                    \
    .count_offset = OFFSET_IN(FILLS, count_, integer),                                             \
    .max_count = sizeof((FILLS *)NULL)->array_ / sizeof *((FILLS *)NULL)->array_

/* ---- rows ------------------------------------------------------------------------------------ */

/* The value of `parts` in struct kiln_option for rows of files that have no parts. `parts` is the
 * first parameter of each row macro. */
#define NO_PART NULL

/* further parameters: name, field, dimension, smallest, largest, clocks, default, help */
#define VALUE(part, n, f, dim, lo, hi, when, def, h)                                               \
    {                                                                                              \
        ROW(part, n, value, f, def, h), LIMITS(dim, lo, hi), .clocks = when                        \
    }
#define VECTOR(part, n, f, dim, lo, hi, when, def, h)                                              \
    {                                                                                              \
        ROW(part, n, vector, f, def, h), LIMITS(dim, lo, hi), .clocks = when                       \
    }
#define RANGE(part, n, f, dim, lo, hi, when, def, h)                                               \
    {                                                                                              \
        ROW(part, n, range, f, def, h), LIMITS(dim, lo, hi), .clocks = when                        \
    }
/* further parameters: name, field, largest, clocks, default, help */
#define COLOR(part, n, f, hi, when, def, h)                                                        \
    {                                                                                              \
        ROW(part, n, color, f, def, h), LIMITS(KILN_PLAIN, 0, hi), .clocks = when                  \
    }
/* further parameters: name, field, smallest, largest, default, help */
#define INTEGER(part, n, f, lo, hi, def, h)                                                        \
    {                                                                                              \
        ROW(part, n, integer, f, def, h), LIMITS(KILN_PLAIN, lo, hi)                               \
    }
/* further parameters: name, field, default, help */
#define BOOLEAN(part, n, f, def, h)                                                                \
    {                                                                                              \
        ROW(part, n, boolean, f, def, h)                                                           \
    }
/* further parameters: name, field, words, default, help */
#define CHOICE(part, n, f, words, def, h)                                                          \
    {                                                                                              \
        ROW(part, n, choice, f, def, h), .choices = words                                          \
    }
/* further parameters: name, members, help; each member has a default or is itself required */
#define GROUP(part, n, rows, h)                                                                    \
    {                                                                                              \
        ROW_AT(part, n, group, 0, "{}", h), MEMBERS(rows)                                          \
    }
/* GROUP_AT is a group whose members are those of a field, which is a struct. */
#define GROUP_AT(part, n, f, rows, h)                                                              \
    {                                                                                              \
        ROW_AT(part, n, group, OFFSET_OF_ROWS(f, rows), "{}", h), .members = rows                  \
    }
/* further parameters: name, members, field that says whether it is on, default, help */
#define SWITCH(part, n, rows, enabled, def, h)                                                     \
    {                                                                                              \
        ROW_AT(part, n, switch, 0, def, h), MEMBERS(rows),                                         \
            .count_offset = OFFSET_IN(FILLS, enabled, boolean)                                     \
    }
/* SWITCH_AT is a switch whose members are those of a field, which is a struct. */
#define SWITCH_AT(part, n, f, rows, enabled, def, h)                                               \
    {                                                                                              \
        ROW_AT(part, n, switch, OFFSET_OF_ROWS(f, rows), def, h),                                  \
            .members = rows, .count_offset = OFFSET_IN(FILLS, enabled, boolean)                    \
    }
/* further parameters: name, kinds, field of the kind's number, default, help */
#define KIND(part, n, kinds_, f, def, h)                                                           \
    {                                                                                              \
        ROW_AT(part, n, kind, 0, def, h), .kinds = FILLING(kinds_, FILLS),                         \
                                          .kind_offset = OFFSET_IN(FILLS, f, choice)               \
    }
/* further parameters: name, array, item, field that counts, default, help */
#define LIST(part, n, f, item_, count, def, h)                                                     \
    {                                                                                              \
        ROW_AT(part, n, list, OFFSET_OF_ARRAY(f, item_), def, h),                                  \
            .item = &(item_), .item_size = sizeof(item_##_fills), COUNTED(f, count)                \
    }
/* NAMED_LIST is a list that may also be a mapping of names to its items, whose struct has a text
 * `name`. */
#define NAMED_LIST(part, n, f, item_, count, def, h)                                               \
    {                                                                                              \
        ROW_AT(part, n, list, OFFSET_OF_ARRAY(f, item_), def, h),                                  \
            .item = &(item_), .item_size = sizeof(item_##_fills), COUNTED(f, count),               \
            .is_named = true, .name_offset = OFFSET_IN(item_##_fills, name, text)                  \
    }
/* RESOLVED is a key that is resolved before rows are read: type, name, help. */
#define RESOLVED(part, type_, n, h)                                                                \
    {                                                                                              \
        ROW_AT(part, n, type_, 0, "none", h), .is_unprinted = true                                 \
    }
/* MAP is a mapping of names, with members instead of an item. The struct of an entry begins
 * with `const char *name`. */
#define MAP(part, n, f, rows, count, def, h)                                                       \
    {                                                                                              \
        MEMBERS_OF_MAP(part, n, f, rows, count, def, h)                                            \
    }
#define MEMBERS_OF_MAP(part, n, f, rows, count, def, h)                                            \
    ROW_AT(part, n, map,                                                                           \
           OFFSET_OF_ARRAY(f, rows) + KILN_FIELD_ASSERT(OFFSET_IN(rows##_fills, name, text) == 0,  \
                                                        "an entry of " #f                          \
                                                        " does not begin with its name"),          \
           def, h),                                                                                \
        .members = rows, .item_size = sizeof(rows##_fills), COUNTED(f, count)

#endif
