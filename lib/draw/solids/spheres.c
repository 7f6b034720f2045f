/* The stage: hands over to its technique. */
#include "draw/solids/spheres.h"

#include "base/error.h"
#include "draw/solids/spheres_cpu.h"
#include "draw/solids/spheres_gl.h"

#include <stdlib.h>

struct kiln_spheres_stage {
    struct kiln_spheres_gl *gl; /* one of these two */
    struct kiln_spheres_cpu *cpu;
};

struct kiln_spheres_stage *kiln_spheres_create(struct kiln_device *device,
                                               const struct kiln_scene *scene,
                                               const struct kiln_spheres_params *params,
                                               struct kiln_error *error)
{
    struct kiln_spheres_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "spheres: out of memory");
        return NULL;
    }
    if (kiln_backdrop_rays(params->backdrop))
        stage->cpu = kiln_spheres_cpu_create(scene, params, error);
    else
        stage->gl = kiln_spheres_gl_create(device, scene, params, error);
    if (!stage->cpu && !stage->gl)
        kiln_spheres_destroy(&stage);
    return stage;
}

void kiln_spheres_destroy(struct kiln_spheres_stage **stage)
{
    if (!*stage)
        return;
    kiln_spheres_cpu_destroy(&(*stage)->cpu);
    kiln_spheres_gl_destroy(&(*stage)->gl);
    free(*stage);
    *stage = NULL;
}

bool kiln_spheres_draw(struct kiln_spheres_stage *stage, struct kiln_pool *pool,
                       struct kiln_buffer *entries, uint32_t count, float time_s,
                       struct kiln_error *error)
{
    if (stage->cpu)
        return kiln_spheres_cpu_draw(stage->cpu, pool, entries, count, time_s, error);
    return kiln_spheres_gl_draw(stage->gl, pool, entries, count, time_s, error);
}
