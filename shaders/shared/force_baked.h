/* Computes a baked wind: the sum of other forces, which was written to the points of a grid
 * (bake.h; Heinz 2019, 2.2.5). A sample is an acceleration, and in w a pull.
 *
 * The samples around a place are interpolated along y, then along z, then along x, along which
 * neighbours lie side by side in memory: the host does so for both neighbours at once
 * (sim/step/block_forces.h). */
#ifndef KILN_SHARED_FORCE_BAKED_H
#define KILN_SHARED_FORCE_BAKED_H

#include "shared/force_field.h"

FN float4 baked_mix(float4 a, float4 b, float t)
{
    EXACT float4 apart = FLOAT4(b.x - a.x, b.y - a.y, b.z - a.z, b.w - a.w);
    EXACT float4 part = FLOAT4(apart.x * t, apart.y * t, apart.z * t, apart.w * t);
    EXACT float4 y = FLOAT4(a.x + part.x, a.y + part.y, a.z + part.z, a.w + part.w);
    return y;
}

/* Interpolates along y and z, where `first` is the index of the word with the lowest y and z. */
FN float4 baked_column(SIM_PARAM S(kiln_grid) g, S(grid_place) place, uint first)
{
    uint layer = g.size.x * g.size.y;
    EXACT float4 low = GRID_WORD(first);
    EXACT float4 above_low = GRID_WORD(first + g.size.x);
    EXACT float4 high = GRID_WORD(first + layer);
    EXACT float4 above_high = GRID_WORD(first + layer + g.size.x);
    EXACT float4 before = baked_mix(low, above_low, place.y.part);
    EXACT float4 after = baked_mix(high, above_high, place.y.part);
    EXACT float4 y = baked_mix(before, after, place.z.part);
    return y;
}

FN S(force_effect) baked_effect(float4 sampled)
{
    EXACT S(force_effect) effect = force_none();
    effect.acceleration = FLOAT3(sampled.x, sampled.y, sampled.z);
    effect.pull = sampled.w;
    return effect;
}

FN S(force_effect) force_baked(SIM_PARAM S(force_input) f)
{
    EXACT float3 at = force_field_place(f);
    EXACT S(grid_place) place = grid_find(AROUND(grids[f.grid]), at);
    uint first = grid_index(AROUND(grids[f.grid]), place.x.first, place.y.first, place.z.first);
    EXACT float4 left = baked_column(SIM AROUND(grids[f.grid]), place, first);
    EXACT float4 right = baked_column(SIM AROUND(grids[f.grid]), place, first + 1u);
    EXACT float4 sampled = baked_mix(left, right, place.x.part);
    EXACT S(force_effect) effect = baked_effect(sampled);
    return effect;
}

#endif
