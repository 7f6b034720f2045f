/* Finds the texel of a slot of the pool, for technique `texels`. */
#ifndef KILN_SIM_STEP_PAPERS_TEXELS_GLSL
#define KILN_SIM_STEP_PAPERS_TEXELS_GLSL

#include "shared/papers/step_layout.h"

ivec2 texel_of(uint slot)
{
    return ivec2(slot % uint(SIM_TEXEL_ROW), slot / uint(SIM_TEXEL_ROW));
}

#endif
