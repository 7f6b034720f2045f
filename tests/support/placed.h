/* Loads a scene and makes its pool on the host, in which a test places particles by hand. So a test
 * of one stage of drawing needs no simulation. */
#ifndef KILN_TESTS_PLACED_H
#define KILN_TESTS_PLACED_H

#include "draw/moment/moment.h"

enum { PLACED_MOST = 4096 /* slots of each system */, PLACED_STEP = 30 /* step of the moment */ };

/* A scene at the moment at the end of step PLACED_STEP. */
struct placed {
    struct kiln_scene *scene;
    struct kiln_pool pool;
    struct kiln_particle *records;
    struct kiln_moment moment;
    struct kiln_threads *threads;
};

/* Loads a scene from a text, with an override "KEY=VALUE" unless it is NULL. An error fails the
 * test. */
void placed_set_up(struct placed *f, const char *text, const char *override);
void placed_tear_down(struct placed *f);

/* Adds a particle at rest to a system, which must have fewer than PLACED_MOST. The particle was
 * born at the start of step birth_step, from which its age follows. position: m. */
void placed_add(struct placed *f, uint32_t system, float3 position, uint32_t birth_step);

#endif
