/* Declares the buffers and parameters of the kernels shaders/sim/crowd/interact_*.comp, which
 * compute the interactions of the particles of a system: collisions, gravity, flocking. Those
 * kernels include it first; interact_scan.comp needs one buffer and declares it itself.
 * lib/sim/crowd/interact_gl.c binds the buffers and runs the kernels.
 *
 * A body is a living particle of the system, copied into order of cells. The functions in
 * shared/interact_*.h read these globals by the macros of shared/interact_layout.h, and the host's
 * loops run the same functions: so names in this file must stay those that the macros use. */
#ifndef KILN_SIM_INTERACT_GLSL
#define KILN_SIM_INTERACT_GLSL

#include "shared/limits.h"
#include "shared/platform.h"

#ifdef KEYS_STORED
layout(std430, binding = INTERACT_BIND_KEYS) readonly buffer key_block
{
    float4 value_keys[];
};
#else
layout(std140, binding = SIM_BIND_KEYS) uniform key_block
{
    float4 value_keys[KILN_BLOCK_KEYS];
};
#endif

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
    kiln_body bodies_after[]; /* the bodies after a round; the host swaps the two buffers then */
};

layout(std430, binding = INTERACT_BIND_CELLS) buffer cell_block
{
    /* For each cell of the table: how many bodies it has (interact_count.comp), then where it
     * begins (interact_scan.comp), then where it ends (interact_place.comp). interact_speeds.comp
     * keeps its bounds in the first words, before the cells are filled. interact_find.comp with
     * MOST_AROUND uses the word behind the cells. */
    uint cell_ends[];
};

layout(std430, binding = INTERACT_BIND_PARTNERS) buffer partner_block
{
    uint partners[]; /* for each body, its partner in this round; INTERACT_NOBODY: none */
};

layout(std430, binding = INTERACT_BIND_ENTRIES) buffer entry_block
{
    /* Gravity keeps its sources and sums here, and a flock its means. */
    uvec4 entries[];
};

layout(std430, binding = SIM_BIND_PUSHES) buffer push_block
{
    float4 push_words[]; /* the result, two words a slot; the simulation's step adds it */
};

#ifdef SPINS
layout(std430, binding = INTERACT_BIND_SPINS) buffer spin_block
{
    uvec4 spin_words[];
};

/* Returns the index in spin_words of a slot's rate of spin. A slot has two words. */
uint spin_word(uint slot)
{
    return (interact_params.first_spin + slot) * 2u;
}

/* Copies a body's rate of spin from its slot to TURNING(body); those words lie behind all bodies.
 * Does nothing in a system whose balls do not spin. */
void copy_spin(uint body, uint slot)
{
    if (interact_params.spins != 0u)
        bodies[interact_params.used + body].position_radius = spin_words[spin_word(slot)];
}
#endif

/* Returns the number of this invocation. Work groups are dispatched in rows, since GL limits how
 * many there may be in one direction. */
uint invocation()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return group * SIM_GROUP_SIZE + gl_LocalInvocationID.x;
}

/* Empties the push of a slot. */
void empty_push(uint slot)
{
    uint at = (interact_params.first_push + slot) * 2u;
    push_words[at] = float4(0.0f);
    push_words[at + 1u] = float4(0.0f);
}

/* Returns how many bodies the system has: where the last cell ends, which is known only after
 * interact_place.comp. */
uint body_count()
{
    return cell_ends[interact_params.cell_mask];
}

#endif
