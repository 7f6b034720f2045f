/* Paints with particles (Drone 2007, 7.6.1): what the particles of a step leave on the meshes that
 * take paint, found from their traces (shared/trace.h). Threads of the host do it whatever
 * technique stepped the particles, so the bits are the same everywhere. */
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
    uint32_t mesh_count; /* that take paint; 0: all else is unused */
    struct kiln_paint_mesh *meshes;
    uint32_t slot_count;      /* of the systems that paint, one after the other */
    struct kiln_splat *made;  /* what each slot leaves on the mesh at hand */
    struct kiln_splat *turns; /* those whose turn it is, in their order */
};

/* Errors are those of kiln_chart_create; after one,
 * too, kiln_paint_finish frees what there is. */
bool kiln_paint_init(struct kiln_paint *paint, const struct kiln_scene *scene,
                     struct kiln_threads *threads, struct kiln_error *error);
void kiln_paint_finish(struct kiln_paint *paint);

/* After a step with these parameters, which left these traces: paints the pool's canvases, which it
 * makes in a run's first step. */
bool kiln_paint_step(struct kiln_paint *paint, const struct kiln_sim_params *params,
                     struct kiln_pool *pool, struct kiln_buffer *traces, struct kiln_error *error);

/* Whether canvases of these shapes are those of a run of the scene after its first step. */
bool kiln_paint_fits(const struct kiln_scene *scene, const struct kiln_canvas_shape *shapes,
                     uint32_t shape_count);

/* Adds the canvases to a state hash. */
void kiln_paint_hash(const struct kiln_pool *pool, struct kiln_state_hash *hash);

#endif
