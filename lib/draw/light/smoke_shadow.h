/* The shadow of smoke: how much of it light has crossed at each place, along the sun's direction
 * and from straight above. Smoke shadows itself and what lies below it.
 */
#ifndef KILN_DRAW_LIGHT_SMOKE_SHADOW_H
#define KILN_DRAW_LIGHT_SMOKE_SHADOW_H

#include "draw/light/smoke.h"

enum {
    KILN_SMOKE_GRID = 64,     /* cells along each edge */
    KILN_MAX_SMOKE_GRIDS = 2, /* filled at once */
};

/* Optical depth in a box of cells, rows along the box's first axis; the third one points to the
 * light. */
struct kiln_smoke_grid {
    float3 direction;        /* towards the light, of length 1 */
    float4 world_to_grid[3]; /* rows: a world position to 0..1 in each axis */
    float *depth;            /* the caller's: KILN_SMOKE_GRID cubed; at a cell's centre */
};

/* Memory to fill grids in. */
struct kiln_smoke_shadow;

/* NULL: no memory. */
struct kiln_smoke_shadow *kiln_smoke_shadow_create(void);
void kiln_smoke_shadow_destroy(struct kiln_smoke_shadow **shadow);

/* Fills grids, whose direction and depth are set, with the same smoke. False when there is no smoke
 * at all; the grids then mean nothing. The number of threads makes no difference. */
bool kiln_smoke_shadow_fill(struct kiln_smoke_shadow *shadow, const struct kiln_smoke *smoke,
                            struct kiln_threads *threads, struct kiln_smoke_grid *grids,
                            uint32_t count);

#endif
