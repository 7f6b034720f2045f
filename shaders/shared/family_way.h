/* Counts the metres that particles have travelled, for children that are born by the metre, and
 * their impacts, where more are counted than the birth word can. Both are part of the state (struct
 * kiln_spin). The sum of metres is one of integers, so that rounding does not accumulate: however
 * many steps a way has, its error is that of the lengths of its pieces. */
#ifndef KILN_SHARED_FAMILY_WAY_H
#define KILN_SHARED_FAMILY_WAY_H

#include "shared/trace.h"

/* Kernels without rows of spins and ways are compiled without this. */
#if !defined(GL_core_profile) || defined(SPINS)
#define FAMILY_HAS_WAYS 1
#else
#define FAMILY_HAS_WAYS 0
#endif

struct family_way {
    uint metres; /* whole ones */
    uint parts;  /* 2^-32 of a metre */
};

/* The two straight pieces of a particle's way through a step: to the first impact, and on. */
struct family_pieces {
    float first, second; /* m */
};

FN S(family_pieces) family_pieces_of(S(kiln_trace) t)
{
    EXACT float3 start = trace_vector(t.start);
    EXACT float3 end = trace_vector(t.end);
    EXACT float3 turn = trace_vector(t.turn);
    EXACT S(family_pieces) pieces;
    if ((t.serial_event.y & TRACE_TURN) == 0u)
        turn = end;
    EXACT float3 first = float3_sub(turn, start);
    EXACT float3 second = float3_sub(end, turn);
    pieces.first = float3_length(first);
    pieces.second = float3_length(second);
    return pieces;
}

/* Returns a length of 0 to 2^24 m; less than 2^-32 m is left out. */
FN S(family_way) family_way_of(float length)
{
    S(family_way) way;
    EXACT float whole = FLOOR(length);
    EXACT float rest = (length - whole) * 65536.0f;
    EXACT float upper = FLOOR(rest);
    EXACT float lower = FLOOR((rest - upper) * 65536.0f);
    way.metres = UINT(whole);
    way.parts = UINT(upper) << 16u | UINT(lower);
    return way;
}

FN S(family_way) family_way_add(S(family_way) a, S(family_way) b)
{
    S(family_way) sum;
    sum.parts = a.parts + b.parts;
    sum.metres = a.metres + b.metres + (sum.parts < a.parts ? 1u : 0u);
    return sum;
}

FN S(family_way) family_way_sub(S(family_way) a, S(family_way) b)
{
    S(family_way) rest;
    rest.parts = a.parts - b.parts;
    rest.metres = a.metres - b.metres - (a.parts < b.parts ? 1u : 0u);
    return rest;
}

/* Returns how many children a way is long. */
FN float family_way_count(S(family_way) way, float per_metre)
{
    EXACT float parts = FLOAT(INT(way.parts >> 8u)) * 5.9604644775390625e-8f;
    EXACT float metres = FLOAT(way.metres) + parts;
    EXACT float count = metres * per_metre;
    return count;
}

#if FAMILY_HAS_WAYS

FN S(family_way) family_way_at(SIM_PARAM uint row)
{
    uint at = row * 2u;
    uint4 words = SPIN_WORD(at);
    S(family_way) way;
    way.parts = words.x;
    way.metres = words.y;
    return way;
}

/* Adds the way through this step to that of a slot, and its impact, if there is one. The slot's
 * particle may be born in this step. */
FN void family_travel(SIM_PARAM uint slot, bool born, S(kiln_trace) t)
{
    EXACT S(family_pieces) pieces = family_pieces_of(t);
    EXACT float length = pieces.first + pieces.second;
    uint row = STEP(family.ways) + slot;
    uint at = row * 2u;
    S(family_way) way = family_way_of(length);
    uint hits = 0u;
    if (!born) {
        way = family_way_add(family_way_at(SIM row), way);
        hits = SPIN_WORD(at).z;
    }
    if ((t.serial_event.y & TRACE_TURN) != 0u && hits < STEP(family.counted))
        hits++;
    SPIN_WORD(at) = UINT4(way.parts, way.metres, hits, 0u);
}

#endif

/* Returns the number of impacts of a slot's particle before this step, of those that are counted.
 */
FN uint family_hits(SIM_PARAM uint slot, S(kiln_particle) p)
{
#if FAMILY_HAS_WAYS
    uint at = (STEP(family.ways) + slot) * 2u;
    if (STEP(family.counted) > KILN_PARTICLE_MOST_HITS)
        return particle_birth_step(p) == STEP(step) ? 0u : SPIN_WORD(at).z;
#endif
    return particle_hits(p);
}

#endif
