/* Stage 4b draws solid particles, spheres and meshes, before the billboards. They become part of
 * the scene, at which soft particles fade and which covers fire and smoke. */
#ifndef KILN_DRAW_SOLIDS_SOLIDS_H
#define KILN_DRAW_SOLIDS_SOLIDS_H

#include "draw/backdrop/backdrop.h"

struct kiln_solids_stage;

/* Images of scene size; they must outlive the stage. */
struct kiln_solids_targets {
    struct kiln_image *backdrop_color, *backdrop_depth; /* read */
    struct kiln_image *color, *depth; /* written: the same with the solids before it */
    struct kiln_image *bloom;         /* written: the solids' part of the bloom, the rest 0 */
};

struct kiln_solids_params {
    const struct kiln_backdrop_stage *backdrop; /* whose technique is the solids', too */
    struct kiln_threads *threads;               /* of `cpu` */
    struct kiln_solids_targets targets;
};

/* The moment, which need not be filled yet, and what params names must outlive the stage; device
 * may be NULL for `cpu`. NULL with an error. */
struct kiln_solids_stage *kiln_solids_create(struct kiln_device *device,
                                             const struct kiln_moment *moment,
                                             const struct kiln_solids_params *params,
                                             struct kiln_error *error);
void kiln_solids_destroy(struct kiln_solids_stage **stage);

/* Draws `count` entries, whose order does not matter, before what kiln_backdrop_draw drew of the
 * same moment and light; a moment for `cpu` has its particles on the host. */
bool kiln_solids_draw(struct kiln_solids_stage *stage, const struct kiln_moment *moment,
                      struct kiln_buffer *entries, uint32_t count, struct kiln_error *error);

#endif
