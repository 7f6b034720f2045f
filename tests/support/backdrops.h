/* Makes backdrops by either technique, so that tests of pictures can run on both. */
#ifndef KILN_TESTS_BACKDROPS_H
#define KILN_TESTS_BACKDROPS_H

#include "draw/backdrop/backdrop.h"

/* All techniques of the backdrop. */
extern const enum kiln_backdrop_technique BACKDROPS[2];

/* The technique of backdrop_create, which tests may set; KILN_BACKDROP_GL at first. */
extern enum kiln_backdrop_technique backdrop_technique;

/* Returns a backdrop that draws into these images, or NULL with an error. */
struct kiln_backdrop_stage *backdrop_create(struct kiln_device *device,
                                            const struct kiln_moment *moment,
                                            struct kiln_image *color, struct kiln_image *depth,
                                            struct kiln_error *error);

/* Draws with the scene's lamps as the only light besides sky and sun: no light or shade of
 * particles, and no shadows of meshes under lamps. */
bool backdrop_draw_by_lamps(struct kiln_backdrop_stage *stage, const struct kiln_moment *moment,
                            struct kiln_error *error);

#endif
