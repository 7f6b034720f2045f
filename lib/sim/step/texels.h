/* Declares technique `texels`, which keeps the state in textures. A fragment shader steps it from
 * one pair of textures to another. */
#ifndef KILN_SIM_STEP_TEXELS_H
#define KILN_SIM_STEP_TEXELS_H

#include "gpu/integer_textures.h"
#include "sim/step/blocks.h"

struct kiln_texels {
    struct kiln_sim_programs programs;
    GLuint to_records, from_records; /* programs */
    /* one texture has position and serial, the other velocity and birth */
    struct kiln_integer_textures state, next;
    uint32_t step; /* the step after which `state` is; 0: none */
};

/* Creates the technique. KILN_NO_DEVICE when the device is not exact in the fragment stage, or, in
 * scenes with children, has no storage blocks there. kiln_texels_finish frees everything, also
 * after a failure. */
bool kiln_texels_init(struct kiln_texels *texels, struct kiln_device *device,
                      const struct kiln_scene *scene, const struct kiln_sim_params *params,
                      struct kiln_error *error);
void kiln_texels_finish(struct kiln_texels *texels);

/* Runs a step, whose blocks have been uploaded; step: its number. */
bool kiln_texels_step(struct kiln_texels *texels, const struct kiln_sim_blocks *blocks,
                      const struct kiln_sim_params *params, struct kiln_pool *pool, uint32_t step,
                      struct kiln_error *error);

#endif
