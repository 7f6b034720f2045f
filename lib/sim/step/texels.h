/* Technique `texels`: the state in textures, which a fragment shader updates from one pair to
 * another. */
#ifndef KILN_SIM_STEP_TEXELS_H
#define KILN_SIM_STEP_TEXELS_H

#include "gpu/words.h"
#include "sim/step/blocks.h"

struct kiln_texels {
    struct kiln_sim_programs programs;
    GLuint to_records, from_records; /* programs */
    struct kiln_words state, next;   /* position and serial; velocity and birth */
    uint32_t step;                   /* that `state` is after; 0: of no step */
};

/* KILN_NO_DEVICE when the device is not exact in the fragment stage, or, in scenes with children,
 * has no storage blocks there. After a failure, too, kiln_texels_finish frees what there is. */
bool kiln_texels_init(struct kiln_texels *texels, struct kiln_device *device,
                      const struct kiln_scene *scene, const struct kiln_sim_params *params,
                      struct kiln_error *error);
void kiln_texels_finish(struct kiln_texels *texels);

/* The step's blocks have been uploaded; step: its number. */
bool kiln_texels_step(struct kiln_texels *texels, const struct kiln_sim_blocks *blocks,
                      const struct kiln_sim_params *params, struct kiln_pool *pool, uint32_t step,
                      struct kiln_error *error);

#endif
