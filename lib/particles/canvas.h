/* A kiln_canvas holds the paint that particles left on a mesh, as a texture, and the splats that
 * wait to be painted. Both are part of the state of a run. sim/paint/paint.h declares which
 * particles paint, and how texels lie on the mesh. */
#ifndef KILN_PARTICLES_CANVAS_H
#define KILN_PARTICLES_CANVAS_H

#include <stdint.h>

#include "base/footprint.h"
#include "kiln.h"

/* A splat of paint that a particle leaves around a position, in the mesh's own space. If its
 * opacity is 0, there is no splat. */
struct kiln_splat {
    float position[3];
    float opacity; /* opacity in the middle, 0..1 */
    /* points away from the surface and has any length; if 0 0 0, the splat paints both sides */
    float normal[3];
    float radius_squared; /* more than 0 */
    float color[3];       /* linear colour */
    /* opacity falls smoothly to 0 over the outer 1 / slope of radius_squared */
    float slope;
};

struct kiln_canvas {
    uint32_t edge;      /* edge of the texture in texels */
    float (*texels)[4]; /* premultiplied linear colour and alpha; rows go with v */
    uint32_t changes;   /* number of steps that changed the texels */
    /* slots of the systems that paint; if 0, all splats are painted in their own step */
    uint32_t slot_count;
    uint32_t next;              /* the slot whose splat is painted next */
    struct kiln_splat *pending; /* a splat for each slot; NULL when slot_count is 0 */
};

/* Describes the sizes of a canvas, which follow from the scene, and the slot that is painted
 * next. */
struct kiln_canvas_shape {
    uint32_t edge, slot_count, next;
};

/* Initialises a canvas without paint. Fails with KILN_DEVICE_FAILED when memory is short;
 * kiln_canvas_finish frees the canvas, also after a failure. */
bool kiln_canvas_init(struct kiln_canvas *canvas, uint32_t edge, uint32_t slot_count,
                      struct kiln_error *error);
void kiln_canvas_finish(struct kiln_canvas *canvas);

/* Adds the memory of a canvas. */
void kiln_canvas_footprint(const struct kiln_canvas_shape *shape, struct kiln_footprint *footprint);

/* Copies a canvas to another canvas of the same size. */
void kiln_canvas_copy(struct kiln_canvas *to, const struct kiln_canvas *from);

/* Adds texels and waiting splats to the sums of a state hash (shared/state_hash.h). A canvas
 * without either adds nothing. */
void kiln_canvas_hash(const struct kiln_canvas *canvas, uint32_t number,
                      struct kiln_state_hash *hash);

#endif
