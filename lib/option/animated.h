/* Reads and prints values, for the option types that consist of them:
 *
 *     0.5    {keys: {0 s: 1, 3 s: 2}}    {life: [0.1, 1.2]}    {random: [1, 2], times: {age: ...}}
 *
 * A vector varies as a whole, where each entry is [x, y, z], or in each component. */
#ifndef KILN_OPTION_ANIMATED_H
#define KILN_OPTION_ANIMATED_H

#include "option/printer.h"
#include "option/reader.h"

/* Describes the times that a key may have. This row belongs to no table. */
extern const struct kiln_option kiln_option_time;

/* Reads a value of 1 or 3 components into values[]. */
bool kiln_read_animated(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, struct kiln_value *values, unsigned count);

/* Reads the components of a constant or of a key, which are plain numbers, or a colour's name. */
bool kiln_read_plain(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, float *out, unsigned count);

/* Append a value or a vector, without a newline. */
void kiln_print_value(struct kiln_printer *printer, const struct kiln_option *option,
                      const struct kiln_value *value);
void kiln_print_vector(struct kiln_printer *printer, const struct kiln_option *option,
                       const struct kiln_value3 *vector);

/* Returns whether a node is a value in the place of a kind's short form: a mapping with a key
 * `keys`, `life`, `age`, `random`, `choose` or `noise`. */
bool kiln_node_is_animated(const struct kiln_node *node);

#endif
