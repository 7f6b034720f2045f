/* Declares how the keys of a value get into the table of keys while a file is read. */
#ifndef KILN_OPTION_VALUE_CURVE_H
#define KILN_OPTION_VALUE_CURVE_H

#include "option/reader.h"
#include "option/value_form.h"

/* Describes a value while it is read. It has `count` components, and a curve of each. */
struct kiln_curve {
    const struct kiln_option *option; /* of the row */
    const struct kiln_value_clock *clock;
    struct kiln_value *values; /* of the components */
    unsigned count;
    uint32_t points;  /* keys read so far */
    uint32_t entries; /* before the first key */
    uint32_t ease;    /* VALUE_LINEAR and so on */
};

/* Takes room in the table for `count` keys of each component, at most KILN_NODE_MAX_ENTRIES, and
 * for the entries before them; fills the values but for the keys. node: what an error is about. */
bool kiln_curve_begin(struct kiln_reader *reader, const struct kiln_node *node,
                      struct kiln_curve *curve, uint32_t count, uint32_t how);

/* Adds a key to each component. node: what an error is about. */
bool kiln_curve_add(struct kiln_reader *reader, const struct kiln_node *node,
                    struct kiln_curve *curve, float x, const float *y);

/* Packs a value as value_unpack reads it. */
float4 kiln_curve_pack(const struct kiln_value *value);

#endif
