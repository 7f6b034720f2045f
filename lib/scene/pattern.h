/* Lists the patterns that the spheres of a look show on their surface. */
#ifndef KILN_SCENE_PATTERN_H
#define KILN_SCENE_PATTERN_H

#include "shared/value.h"

enum kiln_pattern {
    KILN_PATTERN_PLAIN,
    KILN_PATTERN_STRIPE,   /* a band around the equator, in look.color */
    KILN_PATTERN_SEGMENTS, /* segments from pole to pole, as of a beach ball, and caps */
};

struct kiln_look_sphere {
    enum kiln_pattern pattern;
    uint32_t segments;        /* number of segments of each colour */
    struct kiln_value3 color; /* linear; the second colour */
};

#endif
