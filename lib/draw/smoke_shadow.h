/* The shadow of smoke: how much of it light has crossed at each place, along the sun's direction
 * and from straight above. Smoke shadows itself and what lies below it.
 */
#ifndef KILN_DRAW_SMOKE_SHADOW_H
#define KILN_DRAW_SMOKE_SHADOW_H

#include "draw/living.h"

enum { KILN_SMOKE_GRID = 64 }; /* cells along each edge */

/* Optical depth in a box of cells, rows along the box's first axis; the third one points to the
 * light. */
struct kiln_smoke_grid {
    float4 world_to_grid[3]; /* rows: a world position to 0..1 in each axis */
    float *depth;            /* KILN_SMOKE_GRID cubed; at a cell's centre */
};

/* Fills the grid, whose depth the caller owns, with the smoke of all systems that cover, seen from
 * the direction towards the light (of length 1). scratch has room for kiln_smoke_scratch_floats.
 * False when there is no smoke at all; the grid then means nothing. */
bool kiln_smoke_grid_fill(struct kiln_smoke_grid *grid, const struct kiln_scene *scene,
                          const struct kiln_pool *pool, const struct kiln_particle *records,
                          const struct kiln_view *view, const float4 *table, float3 direction,
                          float *scratch);
size_t kiln_smoke_scratch_floats(void);

/* Whether any system throws a shadow. */
bool kiln_smoke_exists(const struct kiln_scene *scene);

#endif
