/* Stage 5a draws the glow around bright particles (Heinz 2019, 2.1.5 and 3.2.5): it finds the light
 * that glows, then blurs it. */
#ifndef KILN_POST_BLOOM_H
#define KILN_POST_BLOOM_H

#include "base/thread.h"
#include "gpu/image.h"
#include "scene/scene.h"

/* Both techniques make the same glow, to rounding. */
enum kiln_bloom_technique { KILN_BLOOM_GL, KILN_BLOOM_CPU };

struct kiln_bloom_stage;

struct kiln_bloom_params {
    enum kiln_bloom_technique technique;
    struct kiln_threads *threads; /* of `cpu` */
    struct kiln_image *source;    /* in which the particles leave their weighted colours, or which
                                   * the bright pass fills */
    GLenum format;                /* of the intermediate images */
};

/* The arguments must outlive the stage; device may be NULL for `cpu`. The scene's bloom must not be
 * KILN_BLOOM_NONE. Returns NULL with an error. */
struct kiln_bloom_stage *kiln_bloom_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           const struct kiln_bloom_params *params,
                                           struct kiln_error *error);
void kiln_bloom_destroy(struct kiln_bloom_stage **stage);

struct kiln_bloom_inputs {
    struct kiln_image *scene, *particles, *fire; /* as for kiln_composite_run; of the bright pass */
    float time_s;                                /* clip time */
};

/* Blurs the glow. The result, smaller than the source, belongs to the stage and holds until the
 * next call; *scale becomes its size in parts of the source's. Returns NULL with an error. */
struct kiln_image *kiln_bloom_run(struct kiln_bloom_stage *stage,
                                  const struct kiln_bloom_inputs *inputs, float *scale,
                                  struct kiln_error *error);

#endif
