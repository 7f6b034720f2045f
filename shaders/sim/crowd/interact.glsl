/* What the kernels that gather pushes read: see shared/interact_layout.h. */
#ifndef KILN_SIM_INTERACT_GLSL
#define KILN_SIM_INTERACT_GLSL

#include "shared/limits.h"
#include "shared/platform.h"

layout(std140, binding = SIM_BIND_KEYS) uniform key_block
{
    float4 value_keys[KILN_MAX_VALUE_KEYS];
};

#include "shared/interact_layout.h"

layout(std140, binding = INTERACT_BIND_PARAMS) uniform interact_block
{
    kiln_interact_params interact_params;
};

layout(std430, binding = SIM_BIND_RECORDS) readonly buffer record_block
{
    kiln_particle records[];
};

layout(std430, binding = INTERACT_BIND_BODIES) buffer body_block
{
    kiln_body bodies[];
};

layout(std430, binding = INTERACT_BIND_SECOND) buffer second_block
{
    kiln_body bodies_after[];
};

layout(std430, binding = INTERACT_BIND_CELLS) buffer cell_block
{
    uint cell_ends[]; /* while they are counted: their bodies, then where each begins */
};

layout(std430, binding = INTERACT_BIND_PARTNERS) buffer partner_block
{
    uint partners[]; /* of each body, another body */
};

layout(std430, binding = INTERACT_BIND_ENTRIES) buffer entry_block
{
    uvec4 entries[]; /* key of a cell (high, low), then a slot or a body */
};

layout(std430, binding = INTERACT_BIND_ORDER) buffer order_block
{
    uint body_order[];
};

layout(std430, binding = SIM_BIND_PUSHES) buffer push_block
{
    float4 push_words[];
};

#ifdef SPINS
layout(std430, binding = INTERACT_BIND_SPINS) buffer spin_block
{
    uvec4 spin_words[];
};

/* The word with a slot's rate. */
uint spin_word(uint slot)
{
    return (interact_params.first_spin + slot) * 2u;
}

/* Of a body, how it turns lies behind all bodies. */
void note_turning(uint body, uint slot)
{
    if (interact_params.spins != 0u)
        bodies[interact_params.used + body].position_radius = spin_words[spin_word(slot)];
}
#endif

uint invocation()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return group * SIM_GROUP_SIZE + gl_LocalInvocationID.x;
}

/* All that there are. */
uint body_count()
{
    return cell_ends[interact_params.cell_mask];
}

#endif
