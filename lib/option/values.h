/* What some options fill; animated numbers are in shared/value.h. */
#ifndef KILN_OPTION_VALUES_H
#define KILN_OPTION_VALUES_H

#include <stdbool.h>
#include <stdint.h>

#include "shared/value.h"

/* What an animated number has as its constant where its option's word stands in its place. */
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
