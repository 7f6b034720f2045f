/* Creates and draws backdrops for tests of pictures. The technique is a variable that tests set, so
 * that the same test runs on GL and on the CPU. */
#ifndef KILN_TESTS_BACKDROPS_H
#define KILN_TESTS_BACKDROPS_H

#include "draw/backdrop/backdrop.h"
#include "support/cmocka.h"

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

/* Runs a group of tests, which need a device, with each technique of the backdrop. The arguments of
 * the program are those of test_list_run. sampled: unless test_is_full, only `cpu` is run, with
 * which gpu.backdrops compares GL. Returns the program's exit status. */
int backdrops_run(const char *name, const struct CMUnitTest *tests, size_t count, bool sampled,
                  int argc, char **argv);

#endif
