/* Lists colliders of many kinds, each with its top at the origin, so that tests can throw the same
 * particles at each of them and expect the same answer. */
#ifndef KILN_TESTS_SURFACES_H
#define KILN_TESTS_SURFACES_H

#include "support/scene_fixture.h"

enum surface_form {
    SURFACE_FLAT,  /* level, at y = 0 */
    SURFACE_ROUND, /* a ball of radius 5 m */
    SURFACE_LYING  /* a cylinder or capsule of radius 5 m along z */
};

enum { SURFACES = 12 };

extern const struct surface {
    const char *name; /* for messages */
    struct kiln_object *(*add)(
        void); /* adds it to the scene of thrown.h; returns NULL for the floor */
    enum surface_form form;
    bool moves; /* a test may animate its centre */
} surfaces[SURFACES];

#endif
