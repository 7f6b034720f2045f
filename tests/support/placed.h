/* A scene's pool on the host, whose particles a test places. */
#ifndef KILN_TESTS_PLACED_H
#define KILN_TESTS_PLACED_H

#include "draw/moment/moment.h"

enum { PLACED_MOST = 4096 /* particles of a system */, PLACED_STEP = 30 };

/* The moment is the end of step PLACED_STEP. */
struct placed {
    struct kiln_scene *scene;
    struct kiln_pool pool;
    struct kiln_particle *records;
    struct kiln_moment moment;
    struct kiln_threads *threads;
};

/* Loads a scene with one override, or none for NULL; tests fail here on errors. */
void placed_set_up(struct placed *f, const char *text, const char *override);
void placed_tear_down(struct placed *f);

/* Places a particle of a system, which is born in a step: its age is known by that. */
void placed_add(struct placed *f, uint32_t system, float3 position, uint32_t birth_step);

#endif
