/* Simulates a scene and draws one frame of it by all stages, with the layers of an EXR, for tests
 * that compare whole frames. */
#ifndef KILN_TESTS_FRAME_H
#define KILN_TESTS_FRAME_H

#include "frame/technique.h"
#include "output/output.h"

/* Numbers of the picture's layers. */
enum { FRAME_BEAUTY, FRAME_DEPTH, FRAME_FIRE, FRAME_SMOKE, FRAME_BLOOM, FRAME_LAYERS };

/* How frame_try and frame_draw draw a frame. */
struct frame_setting {
    const char *overrides[4]; /* of keys of the scene: "KEY=VALUE" */
    size_t count;             /* number of overrides */
    struct kiln_techniques techniques;
    uint32_t threads; /* worker threads; 0 takes two */
};

/* Techniques that draw particles, bloom and the final picture on the host (FRAME_CPU) and on the
 * device (FRAME_GL). */
extern const struct kiln_techniques FRAME_CPU, FRAME_GL;

/* Returns the picture of a scene after `steps` steps, which the caller destroys. If drawing fails,
 * returns NULL and fills *result. Other errors, such as a faulty text, fail the test. */
struct kiln_picture *frame_try(struct kiln_device *device, const char *text, uint32_t steps,
                               const struct frame_setting *setting, struct kiln_error *result);

/* Does what frame_try does, but fails the test if drawing fails. */
struct kiln_picture *frame_draw(struct kiln_device *device, const char *text, uint32_t steps,
                                const struct frame_setting *setting);

/* Returns the relative difference of a layer of two pictures: the sum of |a - b| over all samples,
 * divided by the sum of |a|. Fails the test if a sample of b is not finite. */
double frame_difference(const struct kiln_picture *a, const struct kiln_picture *b, int layer);

#endif
