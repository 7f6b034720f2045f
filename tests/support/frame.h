/* Draws a frame of a scene by all stages, with the layers of an EXR. */
#ifndef KILN_TESTS_FRAME_H
#define KILN_TESTS_FRAME_H

#include "frame/technique.h"
#include "output/output.h"

enum { FRAME_BEAUTY, FRAME_DEPTH, FRAME_FIRE, FRAME_SMOKE, FRAME_BLOOM, FRAME_LAYERS };

/* How a frame is drawn. */
struct frame_setting {
    const char *overrides[4];
    size_t count;
    struct kiln_techniques techniques;
    uint32_t threads; /* 0: two */
};

/* Techniques that draw particles, bloom and the picture on the host, and on the device. */
extern const struct kiln_techniques FRAME_CPU, FRAME_GL;

/* Returns the picture of a scene after `steps` steps, which the caller destroys, or NULL with an
 * error of drawing it. */
struct kiln_picture *frame_try(struct kiln_device *device, const char *text, uint32_t steps,
                               const struct frame_setting *setting, struct kiln_error *result);

/* Returns what frame_try returns; an error fails the test. */
struct kiln_picture *frame_draw(struct kiln_device *device, const char *text, uint32_t steps,
                                const struct frame_setting *setting);

/* Returns the sum of the differences of a layer's samples, divided by the sum of the samples of a.
 */
double frame_difference(const struct kiln_picture *a, const struct kiln_picture *b, int layer);

#endif
