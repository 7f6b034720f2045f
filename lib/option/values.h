/* Declares the structs that some option types fill. Animated numbers are declared in
 * shared/value.h. */
#ifndef KILN_OPTION_VALUES_H
#define KILN_OPTION_VALUES_H

#include <stdbool.h>
#include <stdint.h>

#include "shared/value.h"

/* The constant of an animated number if the file has the option's word instead. */
#define KILN_VALUE_BY_WORD (-1.0f)

/* An integer if the file has the option's word instead. */
#define KILN_INTEGER_BY_WORD UINT32_MAX

/* A range if the file has the option's word instead: no file has one whose ends are so. */
#define KILN_RANGE_BY_WORD                                                                         \
    (struct kiln_range)                                                                            \
    {                                                                                              \
        .min = {.constant = 1.0f}, .max = {.constant = -1.0f }                                     \
    }

static inline bool kiln_range_is_by_word(const struct kiln_range *range)
{
    return range->min.count == 0 && range->max.count == 0 &&
           range->min.constant > range->max.constant;
}

/* Holds a positive fraction in its lowest terms, or 0/1 where the option has a word for it. */
struct kiln_rational {
    uint32_t num, den;
};

/* Holds an axis-aligned box, or none. */
struct kiln_bounds {
    bool enabled;
    float min[3], max[3]; /* m */
};

#endif
