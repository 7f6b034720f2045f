/* Simulates a scene and draws one frame of it by all stages, with the layers of an EXR file, for
 * tests that compare whole frames. */
#ifndef KILN_TESTS_FRAME_H
#define KILN_TESTS_FRAME_H

#include "frame/technique.h"
#include "output/output.h"

/* Indices of the picture's layers. */
enum { FRAME_BEAUTY, FRAME_DEPTH, FRAME_FIRE, FRAME_SMOKE, FRAME_BLOOM, FRAME_LAYERS };

/* How frame_try and frame_draw draw a frame. */
struct frame_setting {
    const char *overrides[4]; /* of the scene's keys: "KEY=VALUE" */
    size_t count;             /* number of overrides */
    struct kiln_techniques techniques;
    uint32_t threads; /* number of worker threads; 0: two threads */
};

/* Techniques that draw particles, bloom and the final picture on the host (FRAME_CPU) and on the
 * device (FRAME_GL). */
extern const struct kiln_techniques FRAME_CPU, FRAME_GL;

/* Draws a scene from a text after `steps` simulation steps. Returns its picture, which the caller
 * destroys, or NULL with *result filled if drawing fails. Other errors, such as a faulty text, fail
 * the test. */
struct kiln_picture *frame_try(struct kiln_device *device, const char *text, uint32_t steps,
                               const struct frame_setting *setting, struct kiln_error *result);

/* Does what frame_try does, but fails the test if drawing fails. */
struct kiln_picture *frame_draw(struct kiln_device *device, const char *text, uint32_t steps,
                                const struct frame_setting *setting);

/* Returns the relative difference of a layer of two pictures: the sum of |a - b| over all samples,
 * divided by the sum of |a|. Fails the test if a sample of b is not finite. */
double frame_difference(const struct kiln_picture *a, const struct kiln_picture *b, int layer);

#endif
