/* Technique `cpu` runs stage `bloom` in threads over rows, in arithmetic that is the same on every
 * machine. Its functions are those of post/bloom.h. */
#ifndef KILN_POST_BLOOM_CPU_H
#define KILN_POST_BLOOM_CPU_H

#include "base/footprint.h"
#include "post/bloom.h"

struct kiln_bloom_cpu;

struct kiln_bloom_cpu *kiln_bloom_cpu_create(struct kiln_device *device,
                                             const struct kiln_scene *scene,
                                             const struct kiln_bloom_params *params,
                                             struct kiln_error *error);

/* Adds the memory of the bloom of a scene. */
void kiln_bloom_cpu_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_bloom_cpu_destroy(struct kiln_bloom_cpu **stage);

struct kiln_image *kiln_bloom_cpu_run(struct kiln_bloom_cpu *stage,
                                      const struct kiln_bloom_inputs *inputs, float *scale,
                                      struct kiln_error *error);

#endif
