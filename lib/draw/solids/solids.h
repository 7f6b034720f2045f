/* Stage 4b draws solid particles, spheres and meshes, before the billboards. Solid particles become
 * part of the scene: they hide fire and smoke behind them, and soft particles fade at them. */
#ifndef KILN_DRAW_SOLIDS_SOLIDS_H
#define KILN_DRAW_SOLIDS_SOLIDS_H

#include "draw/backdrop/backdrop.h"

struct kiln_solids_stage;

/* Names the images of the stage. They have the scene's size and must outlive the stage. */
struct kiln_solids_targets {
    struct kiln_image *backdrop_color, *backdrop_depth; /* read: the picture without solids */
    struct kiln_image *color, *depth;                   /* written: the picture with the solids */
    struct kiln_image *bloom; /* written: the bloom of the solids; 0 elsewhere */
};

struct kiln_solids_params {
    const struct kiln_backdrop_stage *backdrop; /* decides the technique; lights the solids */
    struct kiln_threads *threads;               /* for technique `cpu` */
    struct kiln_solids_targets targets;
};

/* Creates the stage. The moment need not be filled yet; it and all objects in params must outlive
 * the stage. device may be NULL for `cpu`. Returns NULL with an error. */
struct kiln_solids_stage *kiln_solids_create(struct kiln_device *device,
                                             const struct kiln_moment *moment,
                                             const struct kiln_solids_params *params,
                                             struct kiln_error *error);
void kiln_solids_destroy(struct kiln_solids_stage **stage);

/* Draws `count` entries, in any order, over the picture that kiln_backdrop_draw drew for the same
 * moment and lighting. For `cpu` the moment must have its particles on the host. */
bool kiln_solids_draw(struct kiln_solids_stage *stage, const struct kiln_moment *moment,
                      struct kiln_buffer *entries, uint32_t count, struct kiln_error *error);

#endif
