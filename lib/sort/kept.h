/* A kiln_kept holds an order that is kept from frame to frame and sorted a little in each (Kolb,
 * Latta and Rezk-Salama 2004; UberFlow, 4.3 and 5; Heinz 2019, 2.4.1). The order has every slot of
 * the pool exactly once, whether or not a particle was born into it, so no particle can be lost or
 * drawn twice; the living ones are listed from it. */
#ifndef KILN_SORT_KEPT_H
#define KILN_SORT_KEPT_H

#include "sort/oddeven.h"
#include "sort/sort.h"

struct kiln_kept {
    struct kiln_device *device;
    struct kiln_oddeven *oddeven; /* borrowed */
    uint32_t frames;              /* over which the passes of a whole sort are divided */
    uint32_t turn;                /* which of them is next */
    bool started;                 /* the first time, everything is sorted */
    GLuint pad_program, rank_program, slot_program, count_program, list_program;
    struct kiln_scan scan;
    struct kiln_buffer pairs, counts;
};

/* frames: 1 or more. kiln_kept_finish frees what there is, also when this fails. */
bool kiln_kept_init(struct kiln_kept *kept, struct kiln_device *device,
                    struct kiln_oddeven *oddeven, uint32_t frames, struct kiln_error *error);
void kiln_kept_finish(struct kiln_kept *kept);

/* Runs one frame's share of the passes, by the keys of this moment. The pool is always the same
 * one. */
bool kiln_kept_sort(struct kiln_kept *kept, struct kiln_pool *pool, float3 eye, float3 forward,
                    struct kiln_error *error);

/* The order between two sorts, and the part of a sort that comes next: KILN_SORT_NOT_BEGUN before
 * the first. slots: the pool's slot_count. Restoring refuses slots that the pool has not
 * (KILN_INVALID_INPUT). */
bool kiln_kept_save(struct kiln_kept *kept, const struct kiln_pool *pool, uint32_t *slots,
                    uint32_t *turn, struct kiln_error *error);
bool kiln_kept_restore(struct kiln_kept *kept, const struct kiln_pool *pool, const uint32_t *slots,
                       uint32_t turn, struct kiln_error *error);

/* Does the same as kiln_sort_run, in the order as it is; not for KILN_SORT_BY_SERIAL. */
bool kiln_kept_list(struct kiln_kept *kept, struct kiln_pool *pool,
                    const struct kiln_sort_params *params, struct kiln_buffer *entries,
                    uint32_t *count, struct kiln_error *error);

#endif
