/* Declares what the kernels of the staggered grids have beside sim/crowd/interact.glsl. entries[]
 * has the key of a cell (high, low word), by which the entries are sorted, then a slot or a body.
 * Of the cells, only the last one's word is used: how many bodies there are. */
#ifndef KILN_SIM_CROWD_PAPERS_STAGGERED_GLSL
#define KILN_SIM_CROWD_PAPERS_STAGGERED_GLSL

#include "sim/crowd/interact.glsl"

#include "shared/papers/interact_layout.h"

layout(std430, binding = INTERACT_BIND_ORDER) buffer order_block
{
    uint body_order[]; /* order of the second grid, as in stagger_find */
};

#include "shared/papers/interact_staggered.h"

#endif
