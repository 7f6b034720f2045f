/* Paints meshes with the particles that hit them in a step (Drone 2007, 7.6.1). Splats are made
 * from the particles' traces (shared/trace.h). Threads of the host paint for every technique, so
 * the bits are the same everywhere. */
#ifndef KILN_SIM_PAINT_PAINT_H
#define KILN_SIM_PAINT_PAINT_H

#include "asset/geometry/chart.h"
#include "base/thread.h"
#include "sim/paint/paint_gather.h"
#include "sim/world/params.h"

struct kiln_paint_mesh;

struct kiln_paint {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    kiln_paint_block *block;
    uint32_t mesh_count; /* number of meshes that take paint; 0: all other members are unused */
    struct kiln_paint_mesh *meshes;
    uint32_t slot_count;      /* slots of the systems that paint, in the order of the systems */
    struct kiln_splat *made;  /* one splat a slot, for the mesh that is painted */
    struct kiln_splat *turns; /* the splats that are painted by their turn, in order of slots */
};

/* Prepares the meshes of a scene that take paint. Errors are those of kiln_chart_create.
 * kiln_paint_finish frees everything, also after a failure. */
bool kiln_paint_init(struct kiln_paint *paint, const struct kiln_scene *scene,
                     struct kiln_threads *threads, struct kiln_error *error);

/* Adds the memory of the paint of a scene, without canvases. */
void kiln_paint_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_paint_finish(struct kiln_paint *paint);

/* Paints the pool's canvases after a step with these parameters, which left these traces. */
bool kiln_paint_step(struct kiln_paint *paint, const struct kiln_sim_params *params,
                     struct kiln_pool *pool, struct kiln_buffer *traces, struct kiln_error *error);

/* Adds the canvases to a state hash. */
void kiln_paint_hash(const struct kiln_pool *pool, struct kiln_state_hash *hash);

#endif
