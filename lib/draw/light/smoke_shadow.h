/* This header declares the shadow of smoke: the optical depth that the sun's light, and light from
 * straight above, has crossed at each place. Smoke throws a shadow on itself and on objects below
 * it. */
#ifndef KILN_DRAW_LIGHT_SMOKE_SHADOW_H
#define KILN_DRAW_LIGHT_SMOKE_SHADOW_H

#include "draw/light/smoke.h"

enum {
    KILN_SMOKE_GRID = 64,                    /* cells along each edge */
    KILN_SMOKE_COARSE = KILN_SMOKE_GRID / 2, /* cells along each edge of the extinction's grid */
    KILN_MAX_SMOKE_GRIDS = 2,                /* grids of one call */
};

/* Holds the optical depth in a box of cells, rows along the box's first axis; the third axis points
 * to the light. */
struct kiln_smoke_grid {
    float3 direction;        /* towards the light, of length 1 */
    float4 world_to_grid[3]; /* rows: a world position to 0..1 in each axis */
    float *depth;            /* the caller's: KILN_SMOKE_GRID cubed values, at the cells' centres */
    /* Extinction, 1/m: means of 2 x 2 x 2 cells, KILN_SMOKE_COARSE cubed; the caller's, or NULL. */
    float *extinction;
};

/* Holds memory for filling grids. */
struct kiln_smoke_shadow;

/* Returns NULL when memory is short. */
struct kiln_smoke_shadow *kiln_smoke_shadow_create(void);
void kiln_smoke_shadow_destroy(struct kiln_smoke_shadow **shadow);

/* Returns the bytes of the memory that filling grids touches. puffs: particles throw shadows, not
 * gas alone. */
uint64_t kiln_smoke_shadow_bytes(bool puffs);

/* Fills grids, whose direction and depth are set, with the same smoke. Returns false when there is
 * no smoke; the grids are then undefined. The number of threads does not change the result. */
bool kiln_smoke_shadow_fill(struct kiln_smoke_shadow *shadow, const struct kiln_smoke *smoke,
                            struct kiln_threads *threads, struct kiln_smoke_grid *grids,
                            uint32_t count);

/* Fills `depths` with the optical depth of the same smoke without the gas of a domain, whose own
 * smoke dims it otherwise (volume_light.h). It has the places of the first `count` grids of the
 * last call of kiln_smoke_shadow_fill, which must have returned true; its grids, smoke and gas must
 * still be there. Returns false, and fills nothing, if there is no other smoke. */
bool kiln_smoke_shadow_without(struct kiln_smoke_shadow *shadow, uint32_t domain,
                               struct kiln_threads *threads, float *const depths[], uint32_t count);

#endif
