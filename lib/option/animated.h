/* Reads and prints animated numbers and vectors, for the option types that consist of them:
 *
 *     0.5    {keys: {0 s: 1, 3 s: 2}}    {life: [0.1, 1.2]}    {life: {0: 0.1, 0.5: 1, 1: 0}}
 *
 * A vector is animated as a whole, where each entry is [x, y, z], or in each component. */
#ifndef KILN_OPTION_ANIMATED_H
#define KILN_OPTION_ANIMATED_H

#include "option/printer.h"
#include "option/reader.h"

/* Describes the times that a key may have. This row belongs to no table. */
extern const struct kiln_option kiln_option_time;

/* Reads an animated value of 1 or 3 components into values[]. */
bool kiln_read_animated(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, struct kiln_value *values, unsigned count);

/* Appends an animated number, without a newline. */
void kiln_print_animated(struct kiln_printer *printer, const struct kiln_option *option,
                         const struct kiln_value *value);

/* Returns whether a node is a mapping whose first key is `keys` or `life`, the form of an animated
 * number. */
bool kiln_node_is_animated(const struct kiln_node *node);

#endif
