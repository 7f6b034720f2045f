/* Loads a scene, and places particles in it at positions that a test chooses, in host memory. So a
 * test of one stage of drawing needs no simulation. */
#ifndef KILN_TESTS_PLACED_H
#define KILN_TESTS_PLACED_H

#include "draw/moment/moment.h"

enum {
    PLACED_MOST = 4096 /* particle slots of each system */,
    PLACED_STEP = 30 /* drawn at this step's end */
};

/* A scene with its particles, at the end of step PLACED_STEP. */
struct placed {
    struct kiln_scene *scene;
    struct kiln_pool pool;
    struct kiln_particle *records;
    struct kiln_moment moment;
    struct kiln_threads *threads;
};

/* Loads a scene from a text. override: "KEY=VALUE", which replaces a value of the scene, or NULL.
 * An error fails the test. */
void placed_set_up(struct placed *f, const char *text, const char *override);
void placed_tear_down(struct placed *f);

/* Adds a particle at rest to a system that has fewer than PLACED_MOST particles. system: index in
 * the scene; position: m; birth_step: the step at whose start the particle was born, which decides
 * its age. */
void placed_add(struct placed *f, uint32_t system, float3 position, uint32_t birth_step);

#endif
