/* This file writes the samples of baked winds on the host, in blocks of vectors. The stages are the
 * functions of shaders/shared, so the bits are those of bake_sample. */
#include "shared/bake.h"
#include "sim/step/bakes.h"
#include "sim/step/block_forces.h"

#define BAKE_POINTS KILN_SIMD_NAME(kiln_bake_points)

/* Fills in where the samples of a block lie. */
static void place_all(const struct kiln_bake_work *work, uint32_t first, struct kiln_floats3 *at)
{
    const struct kiln_grid grid = work->grid;
    const uint32_t row = first / grid.size.x;
    uint32_t x = first % grid.size.x, y = row % grid.size.y, z = row / grid.size.y;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        kiln_set3(at, i, bake_place(grid, work->node, x, y, z));
        x = x + 1 < grid.size.x ? x + 1 : 0;
        y += x == 0;
        z += y == grid.size.y;
        y = y < grid.size.y ? y : 0;
    }
}

/* Sums up the forces at the points of a block. Those behind the end of the grid are computed, too,
 * and not written. */
__attribute__((flatten)) static void sum_up(const struct kiln_bake_work *work, uint32_t first,
                                            struct kiln_block *b)
{
    const struct kiln_sim *sim = &work->sim;
    place_all(work, first, &b->at);
    memset(&b->start, 0, sizeof b->start);
    b->clocks = (struct kiln_lane_clocks){
        .same_time_s = forces_time_s(sim, sim->step->time_s),
        .position = &b->at,
        .system = sim->step->derived.random_key,
        .scene = sim->step->derived.scene_key,
    };
    add_forces(sim, b, &b->start);
}

void BAKE_POINTS(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_bake_work *work = context;
    float4 *words = work->words + work->grid.size.w;
    struct kiln_block block;
    for (size_t first = begin; first < end; first += KILN_LANES) {
        sum_up(work, (uint32_t)first, &block);
        for (uint32_t i = 0; i < KILN_LANES && first + i < end; i++)
            words[first + i] = bake_word(work->node, effect_at(&block, i));
    }
}
