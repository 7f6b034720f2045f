/* The stages of drawing with what a frame loop lends them. */
#ifndef KILN_TESTS_STAGES_H
#define KILN_TESTS_STAGES_H

#include "frame/stages.h"
#include "sim/step/simulate.h"

/* Stages of `layers` for a pool, with the timer and, unless simulate is NULL, what steps it. */
void stages_open(struct kiln_stages *stages, struct kiln_simulate **simulate,
                 struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_techniques *techniques, bool layers,
                 struct kiln_threads *threads, const struct kiln_pool *pool);

void stages_close(struct kiln_stages *stages, struct kiln_simulate **simulate);

#endif
