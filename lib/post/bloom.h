/* Stage 5a: the bloom target, blurred twice (Heinz 2019, 3.2.5). */
#ifndef KILN_POST_BLOOM_H
#define KILN_POST_BLOOM_H

#include "gpu/image.h"

struct kiln_bloom_stage;

/* For sources of width x height; format is that of the intermediate images. */
struct kiln_bloom_stage *kiln_bloom_create(struct kiln_device *device, uint32_t width,
                                           uint32_t height, GLenum format,
                                           struct kiln_error *error);
void kiln_bloom_destroy(struct kiln_bloom_stage **stage);

/* Blurs source; the result, a sixth of its size, belongs to the stage and holds until the next
 * call. NULL with an error. */
struct kiln_image *kiln_bloom_run(struct kiln_bloom_stage *stage, struct kiln_image *source,
                                  struct kiln_error *error);

#endif
