/* What the sun sees of a mesh, on the host: a map that fits it (mesh_view.h). */
#ifndef KILN_DRAW_MESH_SHADOW_H
#define KILN_DRAW_MESH_SHADOW_H

#include "asset/geometry/mesh.h"
#include "base/thread.h"
#include "draw/backdrop/mesh_view.h"
#include "draw/vector/mesh_rows.h"

struct kiln_mesh_shadow {
    uint32_t *texels;             /* KILN_SHADOW_TEXELS (mesh_view.h) */
    struct kiln_draw_mesh placed; /* what it shows, and under which sun */
    float4 right, up, sun;
    bool drawn;
};

/* Memory that several maps are drawn with, one after the other. */
struct kiln_mesh_canvas {
    struct kiln_threads *threads;
    const struct kiln_mesh_rows *rows;
    struct kiln_flat_triangle *triangles; /* as many as the largest mesh has */
    struct kiln_row_lists lists;
    float *nearness;     /* of each thread: KILN_MESH_ROWS rows of `pitch` floats in every layer */
    size_t strip, pitch; /* floats of a thread; at least KILN_SHADOW_EDGE + KILN_MESH_PAD */
};

bool kiln_mesh_shadow_init(struct kiln_mesh_shadow *shadow, struct kiln_error *error);
void kiln_mesh_shadow_finish(struct kiln_mesh_shadow *shadow);

/* Draws the map anew, unless it shows this already. */
bool kiln_mesh_shadow_update(struct kiln_mesh_shadow *shadow, struct kiln_mesh_canvas *canvas,
                             const struct kiln_mesh *mesh, const struct kiln_draw_mesh *placed,
                             const struct kiln_draw_shapes *shapes, float4 sun,
                             struct kiln_error *error);

#endif
