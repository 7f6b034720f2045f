/* Stage 4b, before the billboards: particles that are opaque spheres. They become part of the scene
 * that soft particles fade at and that covers fire and smoke. */
#ifndef KILN_DRAW_SPHERES_H
#define KILN_DRAW_SPHERES_H

#include "draw/backdrop/backdrop.h"
#include "draw/sprites/particles.h"

struct kiln_spheres_stage;

/* Images of scene size; they must outlive the stage. */
struct kiln_spheres_targets {
    struct kiln_image *backdrop_color, *backdrop_depth; /* read */
    struct kiln_image *color, *depth; /* written: the same with the spheres before it */
    struct kiln_image *bloom;         /* written: the spheres' part of the bloom, the rest 0 */
};

struct kiln_spheres_params {
    const struct kiln_backdrop_stage *backdrop; /* whose technique is the spheres', too */
    struct kiln_particles_stage *particles;     /* of `gl`: lends its tables */
    struct kiln_threads *threads;               /* of `cpu` */
    struct kiln_spheres_targets targets;
};

/* Scene and what params names must outlive the stage; device may be NULL for `cpu`. NULL with an
 * error. */
struct kiln_spheres_stage *kiln_spheres_create(struct kiln_device *device,
                                               const struct kiln_scene *scene,
                                               const struct kiln_spheres_params *params,
                                               struct kiln_error *error);
void kiln_spheres_destroy(struct kiln_spheres_stage **stage);

/* Draws `count` entries, whose order does not matter, before what kiln_backdrop_draw drew and in
 * the same view and light. time_s: clip time. */
bool kiln_spheres_draw(struct kiln_spheres_stage *stage, struct kiln_pool *pool,
                       struct kiln_buffer *entries, uint32_t count, float time_s,
                       struct kiln_error *error);

#endif
