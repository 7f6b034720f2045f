/* The bloom stage, stage 5a of a frame, draws the glow around bright particles (Heinz 2019, 2.1.5
 * and 3.2.5): it finds the light that glows, then blurs it. */
#ifndef KILN_POST_BLOOM_H
#define KILN_POST_BLOOM_H

#include "base/footprint.h"
#include "base/thread.h"
#include "gpu/image.h"
#include "scene/scene.h"

/* Both techniques make the same glow except for rounding. */
enum kiln_bloom_technique { KILN_BLOOM_GL, KILN_BLOOM_CPU };

struct kiln_bloom_stage;

struct kiln_bloom_params {
    enum kiln_bloom_technique technique;
    struct kiln_threads *threads; /* for KILN_BLOOM_CPU */
    struct kiln_image *source;    /* the light that glows: drawn with the particles, in colours
                                   * times their bloom weights, or filled by the bright pass */
    GLenum format;                /* of the intermediate images */
};

/* The arguments must outlive the stage; device may be NULL for KILN_BLOOM_CPU. The scene's bloom
 * must not be KILN_BLOOM_NONE. Returns NULL with an error on failure. */
struct kiln_bloom_stage *kiln_bloom_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           const struct kiln_bloom_params *params,
                                           struct kiln_error *error);

/* Adds the memory of the technique `cpu`. */
void kiln_bloom_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_bloom_destroy(struct kiln_bloom_stage **stage);

struct kiln_bloom_inputs {
    struct kiln_image *scene, *particles, *fire; /* for the bright pass; see struct
                                                  * kiln_composite_inputs */
    float time_s;                                /* clip time */
};

/* Blurs the glow. The stage owns the result, which is valid until the next call. *scale becomes the
 * size of the result divided by that of the source, above 0 and at most 1. Returns NULL with an
 * error on failure. */
struct kiln_image *kiln_bloom_run(struct kiln_bloom_stage *stage,
                                  const struct kiln_bloom_inputs *inputs, float *scale,
                                  struct kiln_error *error);

#endif
