/* This file runs the stage of solid particles by the backdrop's technique, `gl` or `cpu`, since
 * solids share the rays and the light of the backdrop. */
#include "draw/solids/solids.h"

#include <stdlib.h>

#include "base/error.h"
#include "draw/solids/solids_cpu.h"
#include "draw/solids/solids_gl.h"

struct kiln_solids_stage {
    struct kiln_solids_gl *gl;   /* NULL for technique `cpu` */
    struct kiln_solids_cpu *cpu; /* NULL for technique `gl` */
};

struct kiln_solids_stage *kiln_solids_create(struct kiln_device *device,
                                             const struct kiln_moment *moment,
                                             const struct kiln_solids_params *params,
                                             struct kiln_error *error)
{
    struct kiln_solids_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "the solids");
        return NULL;
    }
    if (kiln_backdrop_rays(params->backdrop))
        stage->cpu = kiln_solids_cpu_create(moment, params, error);
    else
        stage->gl = kiln_solids_gl_create(device, moment, params, error);
    if (!stage->cpu && !stage->gl)
        kiln_solids_destroy(&stage);
    return stage;
}

void kiln_solids_destroy(struct kiln_solids_stage **stage)
{
    if (!*stage)
        return;
    kiln_solids_cpu_destroy(&(*stage)->cpu);
    kiln_solids_gl_destroy(&(*stage)->gl);
    free(*stage);
    *stage = NULL;
}

bool kiln_solids_draw(struct kiln_solids_stage *stage, const struct kiln_moment *moment,
                      struct kiln_buffer *entries, uint32_t count, struct kiln_error *error)
{
    if (stage->cpu)
        return kiln_solids_cpu_draw(stage->cpu, moment, entries, count, error);
    return kiln_solids_gl_draw(stage->gl, moment, entries, count, error);
}
