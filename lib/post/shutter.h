/* The shutter stage sums up pictures of several moments while the camera's shutter is open, in
 * linear light. Where a scene has a shutter, it runs before bloom and composite. */
#ifndef KILN_POST_SHUTTER_H
#define KILN_POST_SHUTTER_H

#include "post/composite.h"

/* Names the sums: the composed picture, and the images that later stages or layers ask for. */
enum kiln_shutter_sum {
    KILN_SHUTTER_COMPOSED,
    KILN_SHUTTER_BLOOM,
    KILN_SHUTTER_FIRE,
    KILN_SHUTTER_SMOKE,
    KILN_SHUTTER_SUM_COUNT
};

struct kiln_shutter_stage;

/* The sums are taken where the composite runs, in GL or on the host. */
struct kiln_shutter_params {
    enum kiln_composite_technique technique;
    struct kiln_threads *threads; /* of `cpu`; they must outlive the stage */
    uint32_t width, height;       /* of the images */
};

/* device may be NULL for `cpu`. NULL with an error. */
struct kiln_shutter_stage *kiln_shutter_create(struct kiln_device *device,
                                               const struct kiln_shutter_params *params,
                                               struct kiln_error *error);
void kiln_shutter_destroy(struct kiln_shutter_stage **stage);

/* Adds weight times the picture of a moment, composed (scene, particles and fire of the inputs), or
 * weight times an image, to a sum; the first moment of a frame starts it anew. */
bool kiln_shutter_add_composed(struct kiln_shutter_stage *stage,
                               const struct kiln_composite_inputs *inputs, float weight, bool first,
                               struct kiln_error *error);
bool kiln_shutter_add(struct kiln_shutter_stage *stage, enum kiln_shutter_sum sum,
                      struct kiln_image *image, float weight, bool first, struct kiln_error *error);

/* The image of a sum, which belongs to the stage. */
struct kiln_image *kiln_shutter_image(struct kiln_shutter_stage *stage, enum kiln_shutter_sum sum);

#endif
