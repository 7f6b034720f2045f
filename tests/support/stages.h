/* Makes the stages of drawing, and what a frame loop gives them, for tests without a loop. */
#ifndef KILN_TESTS_STAGES_H
#define KILN_TESTS_STAGES_H

#include "frame/stages.h"
#include "sim/step/simulate.h"

/* Makes the stages for a pool and a timer, with the layers of an EXR if `layers` is true. Unless
 * `simulate` is NULL, makes the simulation, too. */
void stages_open(struct kiln_stages *stages, struct kiln_simulate **simulate,
                 struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_techniques *techniques, bool layers,
                 struct kiln_threads *threads, const struct kiln_pool *pool);

void stages_close(struct kiln_stages *stages, struct kiln_simulate **simulate);

#endif
