/* Defines the sizes, binding points and uniform locations of the sort on the device. A pair is a
 * key and the entry that it belongs to. */
#ifndef KILN_SHARED_SORT_LAYOUT_H
#define KILN_SHARED_SORT_LAYOUT_H

/* Storage blocks. */
#define SORT_BIND_RECORDS   0
#define SORT_BIND_COUNTS    1 /* counts of blocks or digits; scanned in place */
#define SORT_BIND_ENTRIES   2
#define SORT_BIND_PAIRS     3
#define SORT_BIND_PAIRS_OUT 4
#define SORT_BIND_SUMS      5 /* sums of blocks of counts */
#define SORT_BIND_TOTAL     6

/* Locations of uniforms. A kernel has some of them. shared/papers/sort_layout.h has more. */
#define SORT_AT_COUNT       0 /* pairs, counts, or slots of the pool */
#define SORT_AT_SHIFT       1
#define SORT_AT_TILES       2
#define SORT_AT_REVERSE     3
#define SORT_AT_PADDED      4
#define SORT_AT_BUNCH       5
#define SORT_AT_DISTANCE    6
#define SORT_AT_BASE        10
#define SORT_AT_CAPACITY    11
#define SORT_AT_OLDEST      12
#define SORT_AT_USED        13
#define SORT_AT_FIRST_BLOCK 14
#define SORT_AT_SYSTEM      15
#define SORT_AT_EYE         17
#define SORT_AT_FORWARD     18

/* Invocations of a work group, unless another size is given. */
#define SORT_GROUP_SIZE 256

/* Slots, or counts, that one invocation processes; a work group processes a block of them. */
#define SORT_ITEMS 8
#define SORT_BLOCK (SORT_GROUP_SIZE * SORT_ITEMS)

/* Sorting networks: a work group sorts a block of pairs in shared memory, eight for each of its
 * invocations, a power of two. */
#ifndef NETWORK_GROUP_SIZE
#define NETWORK_GROUP_SIZE SORT_GROUP_SIZE
#endif
#define NETWORK_ITEMS 8
#define NETWORK_BLOCK (NETWORK_GROUP_SIZE * NETWORK_ITEMS)

#endif
