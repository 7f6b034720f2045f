/* A kiln_sort_spread holds an order of slots that lasts from frame to frame and is sorted a little
 * in each (Kolb, Latta and Rezk-Salama 2004; UberFlow, 4.3 and 5; Heinz 2019, 2.4.1). The order
 * holds every slot of the pool exactly once, whether or not a particle was born into it, so no
 * particle can be lost or drawn twice. The list of living particles is made from it. */
#ifndef KILN_SORT_SPREAD_H
#define KILN_SORT_SPREAD_H

#include "sort/oddeven.h"
#include "sort/sort.h"

struct kiln_sort_spread {
    struct kiln_device *device;
    struct kiln_oddeven *oddeven; /* borrowed */
    uint32_t part_count;          /* frames over which the passes of a full sort are divided */
    uint32_t next_part; /* index of the part of the full sort that runs next, below part_count */
    bool started;       /* false until the first sort, which runs all passes */
    GLuint pad_program, rank_program, slot_program, count_program, list_program;
    struct kiln_scan scan;
    struct kiln_buffer pairs, counts;
};

/* part_count: 1 or more. kiln_sort_spread_finish frees all resources, also after a failure. */
bool kiln_sort_spread_init(struct kiln_sort_spread *spread, struct kiln_device *device,
                           struct kiln_oddeven *oddeven, uint32_t part_count,
                           struct kiln_error *error);
void kiln_sort_spread_finish(struct kiln_sort_spread *spread);

/* Runs one frame's share of the passes, with keys from the particles and the camera as they are
 * now. Every call must pass the same pool. */
bool kiln_sort_spread_advance(struct kiln_sort_spread *spread, struct kiln_pool *pool, float3 eye,
                              float3 forward, struct kiln_error *error);

/* Save and restore the order between two sorts, and `next_part`, the part of a sort that comes
 * next: KILN_SORT_NOT_BEGUN before the first. slots has room for the pool's slot_count. Restoring
 * fails with KILN_INVALID_INPUT for slots that the pool does not have. */
bool kiln_sort_spread_save(struct kiln_sort_spread *spread, const struct kiln_pool *pool,
                           uint32_t *slots, uint32_t *next_part, struct kiln_error *error);
bool kiln_sort_spread_restore(struct kiln_sort_spread *spread, const struct kiln_pool *pool,
                              const uint32_t *slots, uint32_t next_part, struct kiln_error *error);

/* Does the same as kiln_sort_run, but in the kept order without sorting it. It does not support
 * KILN_SORT_BY_SERIAL. */
bool kiln_sort_spread_list(struct kiln_sort_spread *spread, struct kiln_pool *pool,
                           const struct kiln_sort_params *params, struct kiln_buffer *entries,
                           uint32_t *count, struct kiln_error *error);

#endif
