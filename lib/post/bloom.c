/* This file runs the bloom stage by the technique that was chosen for it, `gl` or `cpu`. */
#include "post/bloom.h"

#include <stdlib.h>

#include "base/error.h"
#include "post/bloom_cpu.h"
#include "post/bloom_gl.h"

struct kiln_bloom_stage { /* exactly one of the two is not NULL */
    struct kiln_bloom_gl *gl;
    struct kiln_bloom_cpu *cpu;
};

struct kiln_bloom_stage *kiln_bloom_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           const struct kiln_bloom_params *params,
                                           struct kiln_error *error)
{
    struct kiln_bloom_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "the bloom");
        return NULL;
    }
    if (params->technique == KILN_BLOOM_CPU)
        stage->cpu = kiln_bloom_cpu_create(device, scene, params, error);
    else
        stage->gl = kiln_bloom_gl_create(device, scene, params, error);
    if (!stage->cpu && !stage->gl)
        kiln_bloom_destroy(&stage);
    return stage;
}

void kiln_bloom_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    if (scene->post.bloom != KILN_BLOOM_NONE)
        kiln_bloom_cpu_footprint(scene, footprint);
}

void kiln_bloom_destroy(struct kiln_bloom_stage **stage)
{
    if (!*stage)
        return;
    kiln_bloom_gl_destroy(&(*stage)->gl);
    kiln_bloom_cpu_destroy(&(*stage)->cpu);
    free(*stage);
    *stage = NULL;
}

struct kiln_image *kiln_bloom_run(struct kiln_bloom_stage *stage,
                                  const struct kiln_bloom_inputs *inputs, float *scale,
                                  struct kiln_error *error)
{
    return stage->cpu ? kiln_bloom_cpu_run(stage->cpu, inputs, scale, error)
                      : kiln_bloom_gl_run(stage->gl, inputs, scale, error);
}
