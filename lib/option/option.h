/* Option tables: one row per key of a file makes the reader, its errors, --set, the printed file,
 * the reference and the JSON schema. To add a key, add a field to the struct that a table fills and
 * a row to the table.
 *
 * A type is a table of functions, so a room that knows more (the assets of a scene, the metrics of
 * a test) has types of its own beside those that are here.
 */
#ifndef KILN_OPTION_OPTION_H
#define KILN_OPTION_OPTION_H

#include <stddef.h>

#include "base/text.h"
#include "option/node.h"
#include "option/unit.h"
#include "option/values.h"

struct kiln_option;
struct kiln_reader;
struct kiln_printer;

/* What a type does with its rows. `field` points at the row's field in the struct of its table. */
struct kiln_option_type {
    bool (*read)(struct kiln_reader *reader, const struct kiln_option *option,
                 const struct kiln_node *node, void *field);
    /* Writes what follows "key:", the newline included. */
    void (*print)(struct kiln_printer *printer, const struct kiln_option *option,
                  const void *field);
    /* Appends what is allowed, for errors and people: "a number in m from 0 to 10". */
    void (*describe)(const struct kiln_option *option, struct kiln_text *out);
    /* Appends a JSON schema, one object. */
    void (*schema)(const struct kiln_option *option, struct kiln_text *out);
    /* Appends the words that a value may be, perhaps beside others, with bars between them:
     * "true|false". NULL: the choices and the word of the row, where it has any. */
    void (*words)(const struct kiln_option *option, struct kiln_text *out);
};

/* The types; what a file says, and the field that it fills. */
extern const struct kiln_option_type kiln_type_boolean;  /* true; bool */
extern const struct kiln_option_type kiln_type_integer;  /* 7; uint32_t */
extern const struct kiln_option_type kiln_type_rational; /* 30000/1001; struct kiln_rational */
extern const struct kiln_option_type kiln_type_number;   /* 2 s; double */
extern const struct kiln_option_type kiln_type_choice;   /* a word of `choices`; an enum */
extern const struct kiln_option_type kiln_type_text;     /* "so", of min to max bytes; char * */
extern const struct kiln_option_type kiln_type_pair;     /* [1280, 720]; uint32_t[2] */
extern const struct kiln_option_type kiln_type_bounds;   /* {min, max} or none; kiln_bounds */
extern const struct kiln_option_type kiln_type_value;    /* animated; struct kiln_value */
extern const struct kiln_option_type kiln_type_vector;   /* animated; struct kiln_value3 */
extern const struct kiln_option_type kiln_type_color;    /* the same; one number means grey */
extern const struct kiln_option_type kiln_type_range;    /* [1, 2] or 1; struct kiln_range */
extern const struct kiln_option_type kiln_type_group;    /* a mapping of `members` */
extern const struct kiln_option_type kiln_type_switch;   /* the same, or none; `count_offset` */
                                                         /* is its bool */
extern const struct kiln_option_type kiln_type_map;      /* names to mappings of `members` */
extern const struct kiln_option_type kiln_type_list;     /* of `item`; an array and its count */
extern const struct kiln_option_type kiln_type_kind;     /* {kind: members}; `kinds` */

/* One of several things that a place may hold, with members of its own. */
struct kiln_option_kind {
    const char *name;                  /* NULL ends a table */
    const char *variant;               /* chosen by `field: variant` inside; NULL: no such choice */
    int value;                         /* goes to the enum at kind_offset */
    const struct kiln_option *members; /* offsets from the start of the item */
    const char *shortcut;              /* the member that a bare value means, or NULL */
    const char *help;
};

enum {
    KILN_KIND_NONE = -1, /* kind_offset of items that are all of one kind */
    KILN_ALLOW_TIME = 1 << KILN_CLOCK_TIME,
    KILN_ALLOW_LIFE = 1 << KILN_CLOCK_LIFE,
    KILN_ALLOW_BOTH = KILN_ALLOW_TIME | KILN_ALLOW_LIFE,
};

struct kiln_option {
    const char *name; /* NULL ends a table */
    const struct kiln_option_type *type;
    size_t offset;        /* of the field in the struct of its table */
    const char *fallback; /* the default, as a file would write it; NULL: required */
    const char *help;     /* one line */
    /* The parts of a file that the row belongs to, a bit each, for printing one of them: of what
     * the whole table describes, and of the struct that its own table describes. NULL: the file has
     * no parts. */
    unsigned (*parts)(const void *source, const void *base);
    double min, max;               /* SI, both allowed */
    enum kiln_dimension dimension; /* of numbers */
    unsigned clocks;               /* KILN_ALLOW_*; a constant always is */
    const char *const *choices;    /* words in the order of the enum, NULL at the end */
    const char *word; /* rational: stands for 0/1; value, of 0 or more: KILN_VALUE_BY_WORD */
    const struct kiln_option *members;
    const struct kiln_option_kind *kinds;
    const struct kiln_option *item; /* of a list */
    int kind_offset;                /* in the item; KILN_KIND_NONE */
    size_t item_size, count_offset; /* arrays: in the struct of the table */
    size_t max_count;
};

/* The number of entries beside an array: both lie in the struct that the row's table describes. */
static inline uint32_t *kiln_option_count_of(const struct kiln_option *option, void *field)
{
    return (uint32_t *)((char *)field - option->offset + option->count_offset);
}

static inline uint32_t kiln_option_count(const struct kiln_option *option, const void *field)
{
    return *(const uint32_t *)((const char *)field - option->offset + option->count_offset);
}

/* The row of a name in a table, or NULL. */
const struct kiln_option *kiln_option_find(const struct kiln_option *table, const char *name);

/* " (did you mean 'rate'?)", or the names that there are; for a message about an unknown name. */
void kiln_option_suggest(char *out, size_t size, const char *name, const char *const *names,
                         size_t count);

/* What may vary, as words: "over time", "over time or life"; NULL for what may not. */
const char *kiln_option_clocks(const struct kiln_option *option);

/* Appends " from 0 m to 10 m". */
void kiln_option_describe_limits(const struct kiln_option *option, struct kiln_text *out);

#endif
