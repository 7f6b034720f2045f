/* The slots of one system in the order of serials: each invocation takes a stretch of them. */
#ifndef KILN_SORT_ALIVE_GLSL
#define KILN_SORT_ALIVE_GLSL

#include "shared/particle.h"
#include "sort/group.glsl"

layout(std430, binding = SORT_BIND_RECORDS) readonly buffer record_block
{
    kiln_particle records[];
};

layout(std430, binding = SORT_BIND_COUNTS) buffer count_block
{
    uint counts[]; /* of the living in each block of all systems */
};

layout(location = 0) uniform uint base; /* the system's first slot */
layout(location = 1) uniform uint capacity;
layout(location = 2) uniform uint oldest;      /* slot of the oldest serial, from base */
layout(location = 3) uniform uint used;        /* slots that were ever born into */
layout(location = 4) uniform uint first_block; /* in counts */
layout(location = 5) uniform uint system;

/* Of the serial that is the i-th oldest. */
uint slot_of(uint i)
{
    uint slot = oldest + i;
    return base + (slot >= capacity ? slot - capacity : slot);
}

uint stretch_begin()
{
    return group_index() * SORT_BLOCK + gl_LocalInvocationID.x * SORT_ITEMS;
}

/* Bit k: the k-th of the stretch lives. */
uint living_of_stretch()
{
    uint first = stretch_begin();
    uint living = 0u;
    for (uint k = 0u; k < SORT_ITEMS; k++) {
        if (first + k < used) {
            uint word = records[slot_of(first + k)].velocity_birth.w;
            living |= (word & KILN_PARTICLE_ALIVE) != 0u ? 1u << k : 0u;
        }
    }
    return living;
}

#endif
