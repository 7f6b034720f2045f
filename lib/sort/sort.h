/* The sort stage, stage 3 of a frame, lists the living particles in the order of drawing. All
 * techniques give the same list; a sort that is spread over frames gives it once its order has
 * caught up with the movement of particles and camera. Additive particles are listed by serial and
 * not sorted. The draw technique `tiled` takes the list from front to back. */
#ifndef KILN_SORT_SORT_H
#define KILN_SORT_SORT_H

#include "base/thread.h"
#include "particles/history.h"

enum kiln_sort_technique {
    KILN_SORT_CPU,
    KILN_SORT_RADIX,
    KILN_SORT_BITONIC,
    KILN_SORT_ODDEVEN,
    KILN_SORT_SPREAD, /* the passes of KILN_SORT_ODDEVEN, divided over frames */
};

/* The greatest number of frames that KILN_SORT_SPREAD can be spread over. */
enum { KILN_SORT_MAX_SPREAD = 64 };

struct kiln_sort;

enum kiln_sort_order {
    KILN_SORT_BY_SERIAL,     /* (system, serial); nothing is sorted */
    KILN_SORT_BACK_TO_FRONT, /* (view depth descending, system, serial) */
    KILN_SORT_FRONT_TO_BACK, /* the exact reverse: equal depths by descending system and serial */
};

struct kiln_sort_params {
    float3 eye;       /* camera position, m */
    float3 forward;   /* view direction, unit length */
    uint64_t systems; /* bit i: system i takes part */
    enum kiln_sort_order order;
};

struct kiln_sort_setup {
    struct kiln_device *device;   /* NULL is allowed for KILN_SORT_CPU */
    struct kiln_threads *threads; /* borrowed; used by KILN_SORT_CPU alone */
    uint32_t frames;              /* KILN_SORT_SPREAD: 1 to KILN_SORT_MAX_SPREAD */
};

/* Creates a sort. Fails with KILN_USAGE when a technique other than KILN_SORT_CPU gets no device or
 * one that does not compute exactly. */
struct kiln_sort *kiln_sort_create(enum kiln_sort_technique technique,
                                   const struct kiln_sort_setup *setup, struct kiln_error *error);
void kiln_sort_destroy(struct kiln_sort **sort);

/* Returns whether lists depend on earlier frames. */
bool kiln_sort_keeps_history(enum kiln_sort_technique technique);

/* Returns what the sort keeps from frame to frame, which lives as long as the sort. */
struct kiln_history kiln_sort_history(struct kiln_sort *sort);

/* Fills entries with the draw entries of the living particles of the chosen systems in the order
 * params->order, and counts them. entries has room for the pool's slot_count; a technique may make
 * it twice as large, to sort in it. If the technique runs on the device, records and entries stay
 * there, and only the count is read back. */
bool kiln_sort_run(struct kiln_sort *sort, struct kiln_pool *pool,
                   const struct kiln_sort_params *params, struct kiln_buffer *entries,
                   uint32_t *count, struct kiln_error *error);

/* Returns the size in bytes of the buffers that grow with the number of slots, the list of entries
 * included. */
uint64_t kiln_sort_bytes(enum kiln_sort_technique technique, uint32_t slots);

#endif
