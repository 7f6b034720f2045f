/* Lists the patterns that the spheres of a look show on their surface. */
#ifndef KILN_SCENE_PATTERN_H
#define KILN_SCENE_PATTERN_H

#include "shared/value.h"

enum kiln_pattern {
    KILN_PATTERN_PLAIN,
    KILN_PATTERN_STRIPE,   /* about its equator, in look.color */
    KILN_PATTERN_SEGMENTS, /* from pole to pole, as a beach ball has, and caps */
};

struct kiln_look_sphere {
    enum kiln_pattern pattern;
    uint32_t segments;        /* of each colour */
    struct kiln_value3 color; /* linear; the other one */
};

#endif
