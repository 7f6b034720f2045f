/* Creates the stages that draw a frame, for tests that run stages one by one instead of rendering a
 * whole clip. */
#ifndef KILN_TESTS_STAGES_H
#define KILN_TESTS_STAGES_H

#include "frame/stages.h"
#include "sim/step/simulate.h"

/* Creates the stages for particles in `pool`, and a timer for them. layers: true if the stages also
 * draw the layers of an EXR file. simulate: set to a new simulation; NULL for none. An error fails
 * the test. */
void stages_open(struct kiln_stages *stages, struct kiln_simulate **simulate,
                 struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_techniques *techniques, bool layers,
                 struct kiln_threads *threads, const struct kiln_pool *pool);

/* Destroys the stages, their timer and, unless `simulate` is NULL, the simulation. */
void stages_close(struct kiln_stages *stages, struct kiln_simulate **simulate);

#endif
