/* Computes a wind field: a pull towards air whose velocity is looked up in a grid (UberFlow 2004,
 * 4.2, whose 3D texture is filtered by the hardware). */
#ifndef KILN_SHARED_FORCE_FIELD_H
#define KILN_SHARED_FORCE_FIELD_H

#include "shared/force.h"
#include "shared/grid.h"

FN S(force_effect) force_field(SIM_PARAM S(force_input) f)
{
    EXACT float4 sampled = grid_at(SIM AROUND(grids[f.grid]), f.position);
    EXACT float3 air = FLOAT3(sampled.x, sampled.y, sampled.z);
    EXACT S(force_effect) effect = force_air(f, air);
    return effect;
}

#endif
