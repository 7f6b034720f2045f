/* Reads the parameters that a file declares, and puts their values where the file names them. */
#ifndef KILN_OPTION_PARAMS_H
#define KILN_OPTION_PARAMS_H

#include "option/expression.h"

enum { KILN_MAX_PARAMS = 256 };

enum { KILN_PARAM_KINDS = KILN_PARAM_FILE + 1 };

/* A parameter. */
struct kiln_param {
    const char *name;
    const char *help; /* "" without one */
    enum kiln_param_kind kind;
    const struct kiln_node *entry; /* its declaration */
    struct kiln_node *fallback;    /* the value that the declaration has */
    struct kiln_node *value;       /* the value that it has: the fallback, or another one */
    struct kiln_option row;        /* what values are allowed, in SI */
    const char *unit;              /* of its numbers; "" for none */
    bool has_min, has_max;
    enum { PARAM_NEW, PARAM_BUSY, PARAM_READY } state;
};

struct kiln_params {
    struct kiln_param list[KILN_MAX_PARAMS];
    uint32_t count;
    int depth; /* of parameters that need each other, while they are made ready */
    /* Checks the text of a file's path, without looking for the file; NULL: any will do. */
    bool (*check_file)(struct kiln_reader *reader, const struct kiln_node *path);
};

/* Reads the declarations. `declared` is NULL where there are none. reader->params holds the
 * parameters from then on, in the reader's scratch arena. */
bool kiln_params_declare(struct kiln_reader *reader, const struct kiln_node *declared);

/* Gives parameters the values of a mapping of names, which is not part of the file: a text in it is
 * a text, whatever it begins with. */
bool kiln_params_set_all(struct kiln_reader *reader, struct kiln_node *values);

/* Gives the parameter of a name a value from outside. Errors of the name are at `place`. */
bool kiln_params_set(struct kiln_reader *reader, const char *name, const struct kiln_node *place,
                     struct kiln_node *value);

/* Checks all values against their kinds and ranges. */
bool kiln_params_check(struct kiln_reader *reader);

/* Writes a value of a parameter as JSON: a number in the parameter's unit, but an angle as a text
 * with its unit. The value has been checked. */
bool kiln_params_write_json(struct kiln_reader *reader, const struct kiln_param *param,
                            const struct kiln_node *value, struct kiln_text *out);

/* Replaces each scalar `$name` of a tree by the parameter's value, and `$$x` by the text `$x`. */
bool kiln_params_replace(struct kiln_reader *reader, struct kiln_node *root);

/* Computes the number of a parameter for arithmetic. False with an error at `node`, the scalar that
 * names it. */
bool kiln_params_quantity(struct kiln_reader *reader, const struct kiln_node *node,
                          const char *name, struct kiln_quantity *quantity);

/* Returns the word of a declaration that says its kind, or NULL. */
const char *kiln_params_kind_of(const struct kiln_node *entry);

/* Returns the word for a kind: "number". */
const char *kiln_params_kind_name(enum kiln_param_kind kind);

/* Appends a node as a file would write it in one line. */
void kiln_node_write(const struct kiln_node *node, struct kiln_text *out);

#endif
