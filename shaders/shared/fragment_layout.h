/* Declares the lists of the fragments of each pixel, for techniques that order particles pixel by
 * pixel (Maule et al. 2012, "Memory-optimized order-independent transparency with dynamic fragment
 * buffer"). Fragments are counted, given places by a scan, written, and sorted. */
#ifndef KILN_SHARED_FRAGMENT_LAYOUT_H
#define KILN_SHARED_FRAGMENT_LAYOUT_H

#include "shared/exact.h"

/* Binding points of storage blocks. */
#define KILN_BIND_FRAGMENT_COUNTS 2
#define KILN_BIND_FRAGMENT_RANGES 3
#define KILN_BIND_FRAGMENT_KEYS   4
#define KILN_BIND_FRAGMENTS       5
#define KILN_BIND_FRAGMENT_MERGED 6 /* keys, in a pass of the sort */
#define KILN_BIND_FRAGMENT_BLOCKS 7 /* long lists: pixel, fragments before the block */

/* Locations of uniforms of the kernel that merges runs of long lists. */
#define KILN_AT_FRAGMENT_BLOCK_COUNT 0
#define KILN_AT_FRAGMENT_RUN         1

/* A list up to this length is sorted by its pixel's invocation, in at most 0.7 n^2 + 10 n
 * iterations. Longer lists are sorted by one invocation a fragment, in blocks. */
#define KILN_FRAGMENT_SHORT 256
#define KILN_FRAGMENT_BLOCK 64

/* A round billboard is drawn as two sheets of half its density. One lies before the plane of its
 * middle and one behind it, each by half of the billboard's depth at the pixel. An object between
 * them is covered by one sheet only. */

/* Returns the alpha of each of two sheets that together have this alpha. */
FN float half_alpha(float alpha)
{
    EXACT float left = exact_max(1.0f - alpha, 0.0f);
    EXACT float passed = exact_sqrt(left);
    EXACT float covered = 1.0f - passed;
    return covered;
}

/* Returns the part of the premultiplied colour of each sheet, so that both together show the whole
 * colour. */
FN float half_color(float alpha_of_half)
{
    EXACT float part = 1.0f / (2.0f - alpha_of_half);
    return part;
}

#endif
