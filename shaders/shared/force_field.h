/* Computes a wind field: a pull towards air whose velocity is looked up in a grid (UberFlow 2004,
 * 4.2, whose 3D texture is filtered by the hardware). */
#ifndef KILN_SHARED_FORCE_FIELD_H
#define KILN_SHARED_FORCE_FIELD_H

#include "shared/force.h"
#include "shared/grid.h"

/* Returns a place in the grid's own metres. The scale is that of the node which the grid lies in,
 * or 0 where it lies in none. */
FN float3 force_field_place(S(force_input) f)
{
    EXACT float3 at = f.position;
    if (USES(USES_FORCES, FORCE_IN_NODE) && f.at.scale > 0.0f) {
        EXACT float per_metre = exact_rcp(f.at.scale);
        at = float3_scale(at, per_metre);
    }
    return at;
}

FN S(force_effect) force_field(SIM_PARAM S(force_input) f)
{
    EXACT float3 at = force_field_place(f);
    EXACT float4 sampled = grid_at(SIM AROUND(grids[f.grid]), at);
    EXACT float3 air = FLOAT3(sampled.x, sampled.y, sampled.z);
    EXACT S(force_effect) effect = force_air(f, air);
    return effect;
}

#endif
