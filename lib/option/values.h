/* What some options fill; animated numbers are in shared/value.h. */
#ifndef KILN_OPTION_VALUES_H
#define KILN_OPTION_VALUES_H

#include <stdbool.h>
#include <stdint.h>

#include "shared/value.h"

/* The constant of an animated number in whose place its option's word stands. */
#define KILN_VALUE_BY_WORD (-1.0f)

/* A positive fraction in its lowest terms, or 0/1 where the option has a word for it. */
struct kiln_rational {
    uint32_t num, den;
};

/* A box along the axes, or none. */
struct kiln_bounds {
    bool enabled;
    float min[3], max[3]; /* m */
};

#endif
