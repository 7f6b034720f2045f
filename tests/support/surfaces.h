/* Lists colliders of many kinds, each with its highest point at the origin, so that tests can throw
 * the same particles at each collider and expect the same bounce. */
#ifndef KILN_TESTS_SURFACES_H
#define KILN_TESTS_SURFACES_H

#include "support/scene_fixture.h"

enum surface_form {
    SURFACE_FLAT,  /* level, at y = 0 */
    SURFACE_ROUND, /* a ball of radius 5 m */
    SURFACE_LYING  /* a cylinder or capsule of radius 5 m along z */
};

enum { SURFACES = 13 };

extern const struct surface {
    const char *name; /* for messages */
    /* Adds the collider to the scene of thrown.h, and returns it; returns NULL for the floor. */
    struct kiln_object *(*add)(void);
    enum surface_form form;
    bool moves; /* true: a test may animate the collider's centre */
} surfaces[SURFACES];

#endif
