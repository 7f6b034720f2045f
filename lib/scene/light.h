/* Declares the lights of a scene besides the sun and fire. */
#ifndef KILN_SCENE_LIGHT_H
#define KILN_SCENE_LIGHT_H

#include <stdbool.h>

#include "scene/node.h"
#include "shared/value.h"

enum kiln_light_kind { KILN_LIGHT_POINT, KILN_LIGHT_SPOT, KILN_LIGHT_RECTANGLE };

struct kiln_light {
    const char *name; /* NULL for an entry of a list */
    enum kiln_light_kind kind;
    struct kiln_attach attach;   /* the light lies in this node */
    struct kiln_value3 position; /* of the centre, m */
    /* Radiance: of a white surface 1 m in front of a point or a spot; of a rectangle itself. */
    struct kiln_value3 color;
    struct kiln_value radius;     /* m: softens the centre: 1 / (d^2 + r^2), and the shadows */
    struct kiln_value3 direction; /* of a spot and a rectangle: where they shine; not zero */
    struct kiln_value angle;      /* rad, of a spot: from its direction to the edge of its cone */
    struct kiln_value softness;   /* part of that angle, at its edge, in which the light fades */
    struct kiln_value width, height; /* of a rectangle, m */
    struct kiln_value3 up;           /* direction that a rectangle's height is nearest to */
    bool shadow;                     /* objects hide it */
};

#endif
