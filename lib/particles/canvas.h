/* Paint that particles left on a mesh, as a texture, and what waits to be painted: part of the
 * state of a run. Who paints, and where its texels lie, is in sim/paint/paint.h. */
#ifndef KILN_PARTICLES_CANVAS_H
#define KILN_PARTICLES_CANVAS_H

#include <stdint.h>

#include "kiln.h"

/* What a particle leaves around a place, in the mesh's own space: all where opacity is 0. */
struct kiln_splat {
    float at[3];
    float opacity;   /* in its middle, 0..1 */
    float normal[3]; /* away from the surface, of any length; 0 0 0: it does not matter */
    float square;    /* of its radius; more than 0 */
    float color[3];  /* linear */
    float slope;     /* opacity falls smoothly to 0 over the outer 1 / slope of that square */
};

struct kiln_canvas {
    uint32_t edge;       /* texels */
    float (*texels)[4];  /* premultiplied linear colour, part covered; rows go with v */
    uint32_t changes;    /* steps that changed it */
    uint32_t slot_count; /* of the particles that paint, where not all are painted in a step */
    uint32_t next;       /* of these, whose turn it is */
    struct kiln_splat *waiting; /* a slot; NULL unless slot_count */
};

/* What of a canvas follows from the scene, and whose turn it is. */
struct kiln_canvas_shape {
    uint32_t edge, slot_count, next;
};

/* Without paint. KILN_DEVICE_FAILED for memory; kiln_canvas_finish frees what there is. */
bool kiln_canvas_init(struct kiln_canvas *canvas, uint32_t edge, uint32_t slot_count,
                      struct kiln_error *error);
void kiln_canvas_finish(struct kiln_canvas *canvas);

/* To another one, which becomes as large if it is not. */
bool kiln_canvas_copy(struct kiln_canvas *to, const struct kiln_canvas *from,
                      struct kiln_error *error);

/* Adds to the sums of a state hash (shared/state_hash.h) what is painted and what waits: nothing
 * where there is neither. */
void kiln_canvas_hash(const struct kiln_canvas *canvas, uint32_t number,
                      struct kiln_state_hash *hash);

#endif
