/* Declares the forms in which a file may write a value that varies: which clocks there are, by
 * their names, and what may stand beside a clock. The reader, the printer and the schema of values
 * share them. */
#ifndef KILN_OPTION_VALUE_FORM_H
#define KILN_OPTION_VALUE_FORM_H

#include "option/option.h"

struct kiln_value_clock {
    const char *name; /* of its key in a file */
    uint32_t clock;   /* KILN_CLOCK_* */
    unsigned allowed; /* the bit KILN_ALLOW_* of rows that take it */
    /* describes the x of keys; this row belongs to no table */
    struct kiln_option axis;
    bool takes_list; /* keys may be a list, whose entries are at equal distances from 0 to 1 */
    bool only_list;
    /* a mapping that begins with the clock is a value also in the place of a kind's short form */
    bool is_short;
};

enum { KILN_VALUE_CLOCKS = 9 };
extern const struct kiln_value_clock kiln_value_clocks[KILN_VALUE_CLOCKS];

/* The names of eases and of repetitions, by VALUE_LINEAR and so on, with NULL at the end. */
extern const char *const kiln_value_eases[];
extern const char *const kiln_value_repeats[];

/* Whose noise it is: that of a system, or of each particle. */
extern const char *const kiln_value_whose[];

/* What may stand beside a clock. */
enum kiln_value_beside_kind {
    KILN_BESIDE_EASE,
    KILN_BESIDE_REPEAT,
    KILN_BESIDE_TIMES,
    KILN_BESIDE_PLUS,
    KILN_BESIDE_SEED,
    KILN_BESIDE_WEIGHTS,
    KILN_BESIDE_PERIOD,
    KILN_BESIDE_OCTAVES,
    KILN_BESIDE_PER,
    KILN_VALUE_BESIDES
};

struct kiln_value_beside {
    const char *name;
    uint32_t clocks; /* bits of the clocks beside which it may stand */
    unsigned rows;   /* bits KILN_ALLOW_*: rows that allow any of them take it */
};

extern const struct kiln_value_beside kiln_value_besides[KILN_VALUE_BESIDES];

/* Returns whether values of a row take something beside their clock. */
bool kiln_value_takes_beside(const struct kiln_option *option, size_t beside);

/* Numbers that stand beside a clock. These rows belong to no table, except that messages name them.
 */
extern const struct kiln_option kiln_value_period, kiln_value_octaves, kiln_value_seed;
extern const struct kiln_option kiln_value_weight;

/* Returns the row of what multiplies a value of a row, or of what is added to it. */
struct kiln_option kiln_value_times_row(const struct kiln_option *option);
struct kiln_option kiln_value_plus_row(const struct kiln_option *option);

/* Returns the clock of a name, or NULL. */
const struct kiln_value_clock *kiln_value_clock_named(const char *name);

/* Appends how a value of a row may be written, for messages: "a constant or a mapping with keys or
 * noise". */
void kiln_value_describe_clocks(const struct kiln_option *option, struct kiln_text *out);

/* Appends the definitions to which the JSON schema of values refers. */
void kiln_value_schema_definitions(struct kiln_text *out);

#endif
