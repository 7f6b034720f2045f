/* Backdrops of either technique, so that tests of what they show run on both. */
#ifndef KILN_TESTS_BACKDROPS_H
#define KILN_TESTS_BACKDROPS_H

#include "draw/backdrop/backdrop.h"

/* All of them. */
extern const enum kiln_backdrop_technique BACKDROPS[2];

/* What backdrop_create takes, for tests to set; KILN_BACKDROP_GL at first. */
extern enum kiln_backdrop_technique backdrop_technique;

struct kiln_backdrop_stage *backdrop_create(struct kiln_device *device,
                                            const struct kiln_moment *moment,
                                            struct kiln_image *color, struct kiln_image *depth,
                                            struct kiln_error *error);

#endif
