/* Declares option tables, one row per key of a file. The reader, its errors, --set, the printed
 * file, the reference and the JSON schema all come from the rows. To add a key, add a field to the
 * struct that a table fills and a row to the table.
 *
 * A type is a table of functions. Other folders of lib/ define types for their own values, such as
 * the assets of a scene or the metrics of a test, in addition to the types declared here. */
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

/* Holds the functions of a type of option. `field` points at the row's field in the struct of its
 * table. */
struct kiln_option_type {
    bool (*read)(struct kiln_reader *reader, const struct kiln_option *option,
                 const struct kiln_node *node, void *field);
    /* Writes the value after "key:", with the newline. */
    void (*print)(struct kiln_printer *printer, const struct kiln_option *option,
                  const void *field);
    /* Appends a description of the allowed values for errors and documents: "a number in m from 0
     * to 10". */
    void (*describe)(const struct kiln_option *option, struct kiln_text *out);
    /* Appends the JSON schema of the value, which is one JSON object. */
    void (*schema)(const struct kiln_option *option, struct kiln_text *out);
    /* Appends the words that are allowed as values, with bars between them: "true|false". Other
     * values may be allowed as well. If NULL, they are the row's `choices` and
     * `special_word`. */
    void (*list_choices)(const struct kiln_option *option, struct kiln_text *out);
};

/* Types of options. Each comment gives an example of the value in a file. */
extern const struct kiln_option_type kiln_type_boolean;  /* true */
extern const struct kiln_option_type kiln_type_integer;  /* 7 */
extern const struct kiln_option_type kiln_type_rational; /* 30000/1001 */
extern const struct kiln_option_type kiln_type_number;   /* 2 s */
extern const struct kiln_option_type kiln_type_choice;   /* a word of `choices` */
extern const struct kiln_option_type kiln_type_text;     /* "so", of min to max bytes */
extern const struct kiln_option_type kiln_type_pair;     /* [1280, 720] */
extern const struct kiln_option_type kiln_type_bounds;   /* {min, max} or none */
extern const struct kiln_option_type kiln_type_value;    /* animated number */
extern const struct kiln_option_type kiln_type_vector;   /* animated vector */
extern const struct kiln_option_type kiln_type_color;    /* animated colour */
extern const struct kiln_option_type kiln_type_range;    /* [1, 2] or 1 */

/* kiln_fills_NAME is the C type of the fields that kiln_type_NAME reads and prints. A row of
 * another field does not compile (option/rows.h). An array without a length stands for an array of
 * any length, whose entries the row's count_offset counts. */
typedef bool kiln_fills_boolean;
typedef uint32_t kiln_fills_integer;
typedef struct kiln_rational kiln_fills_rational;
typedef double kiln_fills_number;
typedef unsigned kiln_fills_choice; /* an enum, of which the compiler makes an unsigned */
typedef const char *kiln_fills_text;
typedef uint32_t kiln_fills_pair[2];
typedef struct kiln_bounds kiln_fills_bounds;
typedef struct kiln_value kiln_fills_value;
typedef struct kiln_value3 kiln_fills_vector;
typedef struct kiln_value3 kiln_fills_color;
typedef struct kiln_range kiln_fills_range;

/* Types of options with members. They fill what the members' table fills, or, of a map or a list,
 * an array of it. */
extern const struct kiln_option_type kiln_type_group;  /* a mapping of `members` */
extern const struct kiln_option_type kiln_type_switch; /* {members} or none, and a bool */
extern const struct kiln_option_type kiln_type_map;    /* names to mappings of `members` */
extern const struct kiln_option_type kiln_type_list;   /* list of `item` */
extern const struct kiln_option_type kiln_type_kind;   /* {kind: members} of `kinds`, and an enum */

/* Types of keys that are resolved before the rows are read (option/include.h, use.h, params.h). */
extern const struct kiln_option_type kiln_type_include; /* [parts/fire.yaml] */
extern const struct kiln_option_type kiln_type_use;     /* the name of another entry */
extern const struct kiln_option_type kiln_type_params;  /* {amount: {number: 1, max: 3}} */

/* Describes one of the kinds of items that a value may be. Each kind has members of its own. */
struct kiln_option_kind {
    const char *name; /* NULL ends a table */
    /* the kind is chosen by `field: variant` in the mapping; NULL: `name` alone chooses it */
    const char *variant;
    int value;                         /* value of the enum at kind_offset */
    const struct kiln_option *members; /* rows whose offsets count from the start of the item */
    /* name of the member that receives a value which is not a mapping, or NULL */
    const char *shortcut;
    const char *help;
};

enum {
    KILN_ALLOW_TIME = 1 << KILN_CLOCK_TIME,
    KILN_ALLOW_LIFE = 1 << KILN_CLOCK_LIFE,
    KILN_ALLOW_BOTH = KILN_ALLOW_TIME | KILN_ALLOW_LIFE,
};

struct kiln_option {
    const char *name; /* NULL ends a table */
    const struct kiln_option_type *type;
    size_t offset;        /* offset of the field in the struct of the row's table */
    const char *fallback; /* the default, as a file would write it; NULL: required */
    const char *help;     /* one line */
    /* Returns a bit mask of the parts of a file that the row belongs to, for printing one part
     * alone. source is the struct that the whole table describes, base the struct of the row's own
     * table. NULL: the file has no parts. */
    unsigned (*parts)(const void *source, const void *base);
    double min, max;               /* limits in SI units, inclusive */
    enum kiln_dimension dimension; /* what a number measures */
    /* KILN_ALLOW_* for keys over time or life; a constant is always allowed */
    unsigned clocks;
    const char *const *choices; /* words in the order of the enum, NULL at the end */
    /* a word that stands for 0/1 (rational) or for KILN_VALUE_BY_WORD (value, whose min is at least
     * 0) */
    const char *special_word;
    const struct kiln_option *members;
    const struct kiln_option_kind *kinds;
    const struct kiln_option *item; /* for a list: the row that describes an item */
    int kind_offset;                /* offset of the item's enum */
    /* for arrays: size of an item, and offset of the count in the struct of the table */
    size_t item_size, count_offset;
    size_t max_count;
    /* of a list: it may also be a mapping of names to items, whose struct has a text for the name
     */
    bool is_named;
    size_t name_offset; /* of that text in the item */
    /* The key is written in files and never printed: what it says is printed by other keys. */
    bool is_unprinted;
    bool is_of_clip;        /* of a number of seconds: it may be written as "50 %" of the clip */
    const char *instead_of; /* another key of the table, which cannot be given as well; or NULL */
};

/* Returns the field that counts the entries of an array. It lies in the struct that the row's table
 * describes, as the array does. */
static inline uint32_t *kiln_option_count_field(const struct kiln_option *option, void *field)
{
    return (uint32_t *)((char *)field - option->offset + option->count_offset);
}

static inline uint32_t kiln_option_count(const struct kiln_option *option, const void *field)
{
    return *(const uint32_t *)((const char *)field - option->offset + option->count_offset);
}

/* Returns the row with this name, or NULL. */
const struct kiln_option *kiln_option_find(const struct kiln_option *table, const char *name);

/* Returns whether a text may name an entry of a map, such as a system. */
bool kiln_option_is_name(const char *text);

/* Writes " (did you mean 'rate'?)", or a list of all names if none is similar, for a message about
 * an unknown name. */
void kiln_option_suggest(char *out, size_t size, const char *name, const char *const *names,
                         size_t count);

/* Returns how a value may vary, as "over time", "over life" or "over time or life", or NULL if it
 * must be constant. */
const char *kiln_option_clocks(const struct kiln_option *option);

/* Appends a text such as " from 0 m to 10 m". */
void kiln_option_describe_limits(const struct kiln_option *option, struct kiln_text *out);

#endif
