/* Compares the techniques of the stage `simulate` with each other. */
#ifndef KILN_TESTS_AGREE_H
#define KILN_TESTS_AGREE_H

#include "kiln.h"

/* Steps the scene of a text by the technique `cpu` and by each of OpenGL, or by `inplace` alone in
 * a short run of the tests (support/parts.h). Fails the test if the state hashes differ after any
 * step, or if no more than 500 particles live at the end. override: a "KEY=VALUE", or NULL. */
void simulation_agree(struct kiln_device *device, const char *text, const char *override,
                      uint32_t steps);

#endif
