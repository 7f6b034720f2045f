/* Finds the pairs that Batcher's odd-even merge sort compares (Batcher 1968; Heinz 2019, 2.4.1).
 * Pass number s (s + 1) / 2 + t, of t = 0 .. s, merges stretches of 2^s pairs into stretches of
 * twice that length, over a distance of 2^(s - t). Each comparison puts the lesser pair first, so
 * no pass undoes the order of earlier passes. That is why the passes may be divided over frames;
 * those of a bitonic sort may not. */
#ifndef KILN_SORT_PAPERS_ODDEVEN_GLSL
#define KILN_SORT_PAPERS_ODDEVEN_GLSL

#include "shared/papers/sort_layout.h"
#include "sort/network.glsl"

/* Finds `low`, the first pair of comparison i of a pass over a distance, in merges of stretches of
 * 2^stage pairs. Returns false if the pass has no such comparison. */
bool comparison(uint i, uint stage, uint distance, out uint low)
{
    uint merged = 1u << stage;
    low = first_of(i, distance, 1u);
    if (distance == merged)
        return true;
    low += distance;
    return (low & (2u * merged - 1u)) + distance < 2u * merged;
}

#endif
