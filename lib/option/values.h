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
