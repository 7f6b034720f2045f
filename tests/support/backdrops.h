/* Creates and draws backdrops for tests of pictures. The technique is a variable that tests set, so
 * that the same test runs on GL and on the CPU. */
#ifndef KILN_TESTS_BACKDROPS_H
#define KILN_TESTS_BACKDROPS_H

#include "draw/backdrop/backdrop.h"

/* All techniques of the backdrop, for loops over them. */
extern const enum kiln_backdrop_technique BACKDROPS[2];

/* The technique that backdrop_create uses. It is KILN_BACKDROP_GL until a test sets another. */
extern enum kiln_backdrop_technique backdrop_technique;

/* Returns a stage that draws the backdrop of a moment into these images, or NULL with an error. The
 * caller destroys the stage before the moment and the images. */
struct kiln_backdrop_stage *backdrop_create(struct kiln_device *device,
                                            const struct kiln_moment *moment,
                                            struct kiln_image *color, struct kiln_image *depth,
                                            struct kiln_error *error);

/* Draws the backdrop in the light of the sky, the sun and the scene's lamps. Particles shed no
 * light and cast no shadows, and meshes hide no lamp. */
bool backdrop_draw_by_lamps(struct kiln_backdrop_stage *stage, const struct kiln_moment *moment,
                            struct kiln_error *error);

#endif
