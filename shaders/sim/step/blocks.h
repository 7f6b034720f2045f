/* Declares the blocks that shared/step.h reads as globals in GLSL, for the kernels of every
 * technique. lib/sim/step/blocks.c binds them. */
#ifndef KILN_SIM_STEP_BLOCKS_H
#define KILN_SIM_STEP_BLOCKS_H

#include "shared/limits.h"
#include "shared/platform.h"

#ifdef GRIDS_WRITTEN
layout(std430, binding = SIM_BIND_GRIDS) buffer grid_block
{
    float4 grid_words[];
};
#elif defined(GRIDS) || defined(KEYS_STORED)
layout(std430, binding = SIM_BIND_GRIDS) readonly buffer grid_block
{
    float4 grid_words[];
};
#endif

#ifdef KEYS_STORED /* the keys are the first words, before those of the grids */
#define value_keys grid_words
#else
layout(std140, binding = SIM_BIND_KEYS) uniform key_block
{
    float4 value_keys[KILN_BLOCK_KEYS];
};
#endif

#include "shared/layout.h"

layout(std140, binding = SIM_BIND_STEP) uniform step_block
{
    kiln_step_params step_params;
};

#ifdef SURROUNDINGS_STORED
layout(std430, binding = SIM_BIND_AROUND) readonly buffer surroundings_block
#else
layout(std140, binding = SIM_BIND_SURROUNDINGS) uniform surroundings_block
#endif
{
    kiln_surroundings surroundings;
};

#ifdef COLLIDE_VOLUME
layout(std430, binding = SIM_BIND_VOLUMES) readonly buffer volume_block
{
    float4 volume_words[];
};
#endif

#ifdef PUSHES
layout(std430, binding = SIM_BIND_PUSHES) readonly buffer push_block
{
    float4 push_words[];
};
#endif

#ifdef SPINS
layout(std430, binding = SIM_BIND_SPINS) buffer spin_block
{
    uvec4 spin_words[];
};
#endif

#endif
