/* A kiln_mesh_shadow is a shadow map on the host. It shows one mesh as the sun sees it, and the
 * map's area fits the mesh. */
#ifndef KILN_DRAW_LIGHT_MESH_SHADOW_H
#define KILN_DRAW_LIGHT_MESH_SHADOW_H

#include "asset/geometry/mesh.h"
#include "base/thread.h"
#include "draw/light/shadow_levels.h"
#include "draw/moment/shapes.h"
#include "draw/vector/mesh_rows.h"

enum {
    KILN_SHADOW_LEVELS = 11, /* each of half the edge of the one before, down to 1 texel */
    KILN_SHADOW_ROWS = 2 * KILN_SHADOW_EDGE, /* of all levels */
    KILN_SHADOW_WORDS =
        KILN_SHADOW_MAP_ENTRIES(KILN_SHADOW_EDGE, KILN_SHADOW_LEVELS) * KILN_SHADOW_PAIR,
};

struct kiln_mesh_shadow {
    uint32_t *texels;               /* KILN_SHADOW_WORDS, the entries of shadow_levels.h */
    struct kiln_shadow_span *spans; /* KILN_SHADOW_ROWS */
    struct kiln_draw_mesh placed;   /* the mesh that the map shows, and the sun at that time */
    float4 right, up, sun;
    bool drawn;
};

/* Holds memory that several maps share; they are drawn one after another. */
struct kiln_mesh_canvas {
    struct kiln_threads *threads;
    const struct kiln_mesh_rows *rows;
    struct kiln_projected_triangle *triangles; /* at least as many as the largest mesh has */
    struct kiln_row_range *ranges;             /* rows of each triangle */
    struct kiln_row_lists lists;
    float *nearness;     /* of each thread: KILN_MESH_ROWS rows of `pitch` floats in every layer */
    size_t strip, pitch; /* floats of a thread; at least KILN_SHADOW_EDGE + KILN_MESH_PAD */
};

bool kiln_mesh_shadow_init(struct kiln_mesh_shadow *shadow, struct kiln_error *error);
void kiln_mesh_shadow_finish(struct kiln_mesh_shadow *shadow);

/* Returns the bytes of a map. */
uint64_t kiln_mesh_shadow_bytes(void);

/* Draws the map, unless it shows the mesh in this position and under this sun already. */
bool kiln_mesh_shadow_update(struct kiln_mesh_shadow *shadow, struct kiln_mesh_canvas *canvas,
                             const struct kiln_mesh *mesh, const struct kiln_draw_mesh *placed,
                             const struct kiln_draw_shapes *shapes, float4 sun,
                             struct kiln_error *error);

#endif
