/* Stage 5a: the glow around what shines (Heinz 2019, 2.1.5 and 3.2.5): what glows is found, then
 * spread. */
#ifndef KILN_POST_BLOOM_H
#define KILN_POST_BLOOM_H

#include "gpu/image.h"
#include "scene/scene.h"

struct kiln_bloom_stage;

/* source: the image in which the particles leave their weighted colours, or which the bright pass
 * fills; format is that of the intermediate images. All must outlive the stage. The scene's bloom
 * must not be KILN_BLOOM_NONE. */
struct kiln_bloom_stage *kiln_bloom_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           struct kiln_image *source, GLenum format,
                                           struct kiln_error *error);
void kiln_bloom_destroy(struct kiln_bloom_stage **stage);

struct kiln_bloom_inputs {
    struct kiln_image *scene, *particles, *fire; /* as for kiln_composite_run; of the bright pass */
    float time_s;                                /* clip time */
};

/* Spreads the glow. The result, smaller than the source, belongs to the stage and holds until the
 * next call; *scale becomes its size in parts of the source's. NULL with an error. */
struct kiln_image *kiln_bloom_run(struct kiln_bloom_stage *stage,
                                  const struct kiln_bloom_inputs *inputs, float *scale,
                                  struct kiln_error *error);

#endif
