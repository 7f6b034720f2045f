/* The shutter stage sums up pictures of several moments in linear light while the camera's shutter
 * is open. It runs before bloom and composite if the scene has a shutter. */
#ifndef KILN_POST_SHUTTER_H
#define KILN_POST_SHUTTER_H

#include "base/footprint.h"
#include "post/composite.h"

/* Names the sums: the composed picture, and the images that later stages or layers ask for. */
enum kiln_shutter_sum {
    KILN_SHUTTER_COMPOSED,
    KILN_SHUTTER_BLOOM,
    KILN_SHUTTER_FIRE,
    KILN_SHUTTER_SMOKE,
    KILN_SHUTTER_GAS,
    KILN_SHUTTER_SUM_COUNT
};

struct kiln_shutter_stage;

/* The sums are computed where the composite stage runs: in GL or on the host. */
struct kiln_shutter_params {
    enum kiln_composite_technique technique;
    struct kiln_threads *threads; /* for KILN_COMPOSITE_CPU; they must outlive the stage */
    uint32_t width, height;       /* of the images */
};

/* device may be NULL for KILN_COMPOSITE_CPU. Returns NULL with an error on failure. */
struct kiln_shutter_stage *kiln_shutter_create(struct kiln_device *device,
                                               const struct kiln_shutter_params *params,
                                               struct kiln_error *error);

/* Adds the memory of the sums of frames of several moments, without those of layers. */
void kiln_shutter_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_shutter_destroy(struct kiln_shutter_stage **stage);

/* kiln_shutter_add_composed adds `weight` times the composed scene, particles and fire of a moment
 * to the sum KILN_SHUTTER_COMPOSED. kiln_shutter_add adds `weight` times an image to a sum. `first`
 * replaces the sum instead of adding to it. */
bool kiln_shutter_add_composed(struct kiln_shutter_stage *stage,
                               const struct kiln_composite_inputs *inputs, float weight, bool first,
                               struct kiln_error *error);
bool kiln_shutter_add(struct kiln_shutter_stage *stage, enum kiln_shutter_sum sum,
                      struct kiln_image *image, float weight, bool first, struct kiln_error *error);

/* Returns the image of a sum, which the stage owns. */
struct kiln_image *kiln_shutter_image(struct kiln_shutter_stage *stage, enum kiln_shutter_sum sum);

#endif
