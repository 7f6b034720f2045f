/* This file runs the composite stage by the technique that was chosen for it, `gl` or `cpu`. */
#include "post/composite.h"

#include <stdlib.h>

#include "base/error.h"
#include "post/composite_cpu.h"
#include "post/composite_gl.h"
#include "post/magnify.h"

struct kiln_composite_stage { /* exactly one of the two is not NULL */
    struct kiln_composite_gl *gl;
    struct kiln_composite_cpu *cpu;
};

struct kiln_composite_stage *kiln_composite_create(struct kiln_device *device,
                                                   const struct kiln_scene *scene,
                                                   const struct kiln_composite_params *params,
                                                   struct kiln_error *error)
{
    struct kiln_composite_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "the composite");
        return NULL;
    }
    if (params->technique == KILN_COMPOSITE_CPU)
        stage->cpu = kiln_composite_cpu_create(scene, params, error);
    else
        stage->gl = kiln_composite_gl_create(device, scene, params, error);
    if (!stage->cpu && !stage->gl)
        kiln_composite_destroy(&stage);
    return stage;
}

void kiln_composite_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const uint64_t plane = scene->width + (uint64_t)(2 * KILN_MAGNIFY_EDGE);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, (uint64_t)scene->width * scene->height,
                       4 * sizeof(uint8_t));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, footprint->threads,
                       3 * plane * sizeof(float));
}

void kiln_composite_destroy(struct kiln_composite_stage **stage)
{
    if (!*stage)
        return;
    kiln_composite_gl_destroy(&(*stage)->gl);
    kiln_composite_cpu_destroy(&(*stage)->cpu);
    free(*stage);
    *stage = NULL;
}

bool kiln_composite_run(struct kiln_composite_stage *stage,
                        const struct kiln_composite_inputs *inputs, struct kiln_error *error)
{
    return stage->cpu ? kiln_composite_cpu_run(stage->cpu, inputs, error)
                      : kiln_composite_gl_run(stage->gl, inputs, error);
}

bool kiln_composite_read_display(struct kiln_composite_stage *stage, void *pixels,
                                 struct kiln_error *error)
{
    if (!stage->cpu)
        return kiln_composite_gl_read_display(stage->gl, pixels, error);
    return kiln_composite_cpu_read_display(stage->cpu, pixels, error);
}

bool kiln_composite_take_beauty(struct kiln_composite_stage *stage, float **pixels,
                                struct kiln_error *error)
{
    if (!stage->cpu)
        return kiln_composite_gl_read_beauty(stage->gl, *pixels, error);
    kiln_composite_cpu_exchange_beauty(stage->cpu, pixels);
    return true;
}
