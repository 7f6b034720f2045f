/* Animated numbers and vectors in a file, for the types that consist of them:
 *
 *     0.5    {keys: {0 s: 1, 3 s: 2}}    {life: [0.1, 1.2]}    {life: {0: 0.1, 0.5: 1, 1: 0}}
 *
 * A vector is animated as a whole, each entry being [x, y, z], or in each component.
 */
#ifndef KILN_OPTION_ANIMATED_H
#define KILN_OPTION_ANIMATED_H

#include "option/printer.h"
#include "option/reader.h"

/* What the time of a key may be: a row without a place. */
extern const struct kiln_option kiln_option_time;

/* Reads 1 or 3 components into values[]. */
bool kiln_read_animated(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, struct kiln_value *values, unsigned count);

/* Appends an animated number, without a newline. */
void kiln_print_animated(struct kiln_printer *printer, const struct kiln_option *option,
                         const struct kiln_value *value);

/* Does a mapping look like an animated number: is its first key `keys` or `life`? */
bool kiln_node_is_animated(const struct kiln_node *node);

#endif
