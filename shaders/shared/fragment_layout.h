/* Lists of the fragments of each pixel, where the order of particles is decided pixel by pixel
 * (Maule et al. 2012, "Memory-optimized order-independent transparency with dynamic fragment
 * buffer": counted, given places by a scan, filled in, sorted).
 */
#ifndef KILN_SHARED_FRAGMENT_LAYOUT_H
#define KILN_SHARED_FRAGMENT_LAYOUT_H

#include "shared/exact.h"

/* Binding points of storage blocks. */
#define KILN_BIND_FRAGMENT_COUNTS 2
#define KILN_BIND_FRAGMENT_PLACES 3
#define KILN_BIND_FRAGMENT_KEYS   4
#define KILN_BIND_FRAGMENTS       5
#define KILN_BIND_FRAGMENT_MERGED 6 /* keys, by a pass of the sort */
#define KILN_BIND_FRAGMENT_BLOCKS 7 /* of long lists: the pixel; its fragments before the block */

/* A list no longer than this is sorted by its pixel's invocation, which needs no more than 0.7 n^2
 * + 10 n iterations; longer ones by an invocation a fragment, in blocks. */
#define KILN_FRAGMENT_SHORT 256
#define KILN_FRAGMENT_BLOCK 64

/* A round billboard is two sheets of half its density, one before the plane of its middle and one
 * behind it, each by half of its depth there: what flies through it is covered by the one only. */

/* Alpha of each of two sheets that together have alpha. */
FN float half_alpha(float alpha)
{
    EXACT float left = exact_max(1.0f - alpha, 0.0f);
    EXACT float passed = exact_sqrt(left);
    EXACT float covered = 1.0f - passed;
    return covered;
}

/* Part of the premultiplied colour that each sheet shows, so that together they show all of it. */
FN float half_color(float alpha_of_half)
{
    EXACT float part = 1.0f / (2.0f - alpha_of_half);
    return part;
}

#endif
