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
    /* the kind is chosen by `field: variant` in the mapping, or by a mapping of that name inside of
     * it; NULL: `name` alone chooses it */
    const char *variant;
    int value;                         /* value of the enum at kind_offset */
    const struct kiln_option *members; /* rows whose offsets count from the start of the item */
    /* name of the member that receives a value which is not a mapping, or NULL */
    const char *shortcut;
    const char *help;
};

/* The clocks that a value may have, and combinations of them. */
enum {
    KILN_ALLOW_TIME = 1 << KILN_CLOCK_TIME,
    KILN_ALLOW_LIFE = 1 << KILN_CLOCK_LIFE,
    KILN_ALLOW_AGE = 1 << KILN_CLOCK_AGE,
    KILN_ALLOW_SPEED = 1 << KILN_CLOCK_SPEED,
    KILN_ALLOW_HEIGHT = 1 << KILN_CLOCK_HEIGHT,
    KILN_ALLOW_DISTANCE = 1 << KILN_CLOCK_DISTANCE,
    KILN_ALLOW_RANDOM = 1 << KILN_CLOCK_RANDOM,
    KILN_ALLOW_NOISE = 1 << KILN_CLOCK_NOISE, /* the same for all particles */
    KILN_ALLOW_OWN_NOISE = 1 << 9,            /* of each particle */
    KILN_ALLOW_FORMS = 1 << 10,               /* curved eases, and repetition */
    KILN_ALLOW_PARTS = 1 << 11,               /* `times` and `plus` */

    /* the same for all particles at a time */
    KILN_OVER_TIME = KILN_ALLOW_TIME | KILN_ALLOW_NOISE | KILN_ALLOW_FORMS | KILN_ALLOW_PARTS,
    /* evaluated once for a particle, at its birth */
    KILN_AT_BIRTH = KILN_OVER_TIME | KILN_ALLOW_RANDOM,
    /* evaluated for a particle whenever it moves */
    KILN_OVER_LIFE = KILN_AT_BIRTH | KILN_ALLOW_LIFE | KILN_ALLOW_AGE | KILN_ALLOW_SPEED |
                     KILN_ALLOW_HEIGHT | KILN_ALLOW_OWN_NOISE,
    /* evaluated for a particle when it is drawn */
    KILN_WHEN_DRAWN = KILN_OVER_LIFE | KILN_ALLOW_DISTANCE,
    /* summed up over a particle's life */
    KILN_SUMMED_UP = KILN_ALLOW_TIME | KILN_ALLOW_LIFE | KILN_ALLOW_RANDOM | KILN_ALLOW_PARTS,
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
    unsigned clocks; /* KILN_ALLOW_*: how a value may vary; a constant is always allowed */
    /* the number of the row among those whose values may be random or a noise: it decides what they
     * draw, so it must not change. No other row of a system has it, nor, of rows outside of
     * systems, another one. */
    unsigned draws;
    const char *const *choices; /* words in the order of the enum, NULL at the end */
    /* a word that stands for 0/1 (rational), KILN_VALUE_BY_WORD (value, whose min is at least 0),
     * KILN_RANGE_BY_WORD (range) or KILN_INTEGER_BY_WORD (integer, whose max is below it) */
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
    bool is_hidden_if_empty; /* of a map: it is not printed if it has no entries */
    bool is_counted; /* of a map: its entries draw numbers of their own, as those of a list do */
    bool is_of_clip; /* of a number of seconds: it may be written as "50 %" of the clip */
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

/* Returns the value of a key inside of a node that alone chooses among the kinds of a name, as in
 * `wind: {grid: {...}}`; otherwise NULL. */
const struct kiln_node *kiln_option_variant_inside(const struct kiln_option_kind *kinds,
                                                   const char *name, const struct kiln_node *node);

/* Returns the kind of a name that a node chooses by having a key that is the kind's variant and one
 * of its members, as in `wind: {gas: fire, pull: 3}`; otherwise NULL. */
const struct kiln_option_kind *kiln_option_variant_by_member(const struct kiln_option_kind *kinds,
                                                             const char *name,
                                                             const struct kiln_node *node);

/* Returns the row with this name, or NULL. */
const struct kiln_option *kiln_option_find(const struct kiln_option *table, const char *name);

/* Returns whether a text may name an entry of a map, such as a system. */
bool kiln_option_is_name(const char *text);

/* Writes " (did you mean 'rate'?)", or a list of all names if none is similar, for a message about
 * an unknown name. */
void kiln_option_suggest(char *out, size_t size, const char *name, const char *const *names,
                         size_t count);

/* Returns how a value may vary, such as "over time", or NULL if it must be constant. */
const char *kiln_option_clocks(const struct kiln_option *option);

/* Appends a text such as " from 0 m to 10 m". */
void kiln_option_describe_limits(const struct kiln_option *option, struct kiln_text *out);

#endif
