/* Creates and draws backdrops, the scene behind the particles, for tests of pictures. The technique
 * is a global variable, so that the same test runs once with GL and once on the CPU. */
#ifndef KILN_TESTS_BACKDROPS_H
#define KILN_TESTS_BACKDROPS_H

#include "draw/backdrop/backdrop.h"
#include "support/cmocka.h"

/* The technique that backdrop_create uses. It is KILN_BACKDROP_GL until a test sets another. */
extern enum kiln_backdrop_technique backdrop_technique;

/* Returns a stage that draws the backdrop into the images `color` and `depth`, or NULL with an
 * error. moment: the scene at the instant that is drawn. The caller destroys the stage before the
 * moment and the images. */
struct kiln_backdrop_stage *backdrop_create(struct kiln_device *device,
                                            const struct kiln_moment *moment,
                                            struct kiln_image *color, struct kiln_image *depth,
                                            struct kiln_error *error);

/* Draws the backdrop in the light of the sky, the sun and the scene's lamps. Particles shed no
 * light and cast no shadows, and meshes cast no shadows under lamps. */
bool backdrop_draw_by_lamps(struct kiln_backdrop_stage *stage, const struct kiln_moment *moment,
                            struct kiln_error *error);

/* Runs a group of tests, which need a device, with each technique of the backdrop, `cpu` and GL.
 * argc, argv: passed on to test_list_run. sampled: true to run only `cpu` unless test_is_full,
 * since gpu.backdrops compares GL with `cpu`. Returns the program's exit status. */
int backdrops_run(const char *name, const struct CMUnitTest *tests, size_t count, bool sampled,
                  int argc, char **argv);

#endif
