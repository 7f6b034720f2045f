/* Lists one collider of each kind, with its top at the origin. */
#ifndef KILN_TESTS_SURFACES_H
#define KILN_TESTS_SURFACES_H

#include "support/scene_fixture.h"

enum surface_form { SURFACE_FLAT, SURFACE_ROUND, SURFACE_LYING };

enum { SURFACES = 12 };

extern const struct surface {
    const char *name;
    struct kiln_object *(*add)(void); /* adds it to the scene of thrown.h; NULL for the floor */
    enum surface_form form;
    bool moves; /* a test may move its centre */
} surfaces[SURFACES];

#endif
