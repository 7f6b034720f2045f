/* Compares the techniques of the stage `simulate` with each other. */
#ifndef KILN_TESTS_AGREE_H
#define KILN_TESTS_AGREE_H

#include <stddef.h>

#include "sim/step/simulate.h"

/* The techniques of OpenGL that a test compares with `cpu`. */
struct simulation_way {
    enum kiln_simulate_technique technique;
    const char *name;
};
extern const struct simulation_way simulation_ways[];

/* Returns how many of them a run of the tests takes: all, or `inplace` alone in a short run
 * (support/parts.h). */
size_t simulation_way_count(void);

/* Steps the scene of a text by the technique `cpu` and by those of OpenGL. Fails the test if the
 * state hashes differ after any step, or if no more than 500 particles live at the end. override: a
 * "KEY=VALUE", or NULL. */
void simulation_agree(struct kiln_device *device, const char *text, const char *override,
                      uint32_t steps);

#endif
