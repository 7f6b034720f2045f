/* A kiln_kept holds an order of slots that lasts from frame to frame and is sorted a little in each
 * (Kolb, Latta and Rezk-Salama 2004; UberFlow, 4.3 and 5; Heinz 2019, 2.4.1). The order holds every
 * slot of the pool exactly once, whether or not a particle was born into it, so no particle can be
 * lost or drawn twice. The list of living particles is made from it. */
#ifndef KILN_SORT_KEPT_H
#define KILN_SORT_KEPT_H

#include "sort/oddeven.h"
#include "sort/sort.h"

struct kiln_kept {
    struct kiln_device *device;
    struct kiln_oddeven *oddeven; /* borrowed */
    uint32_t frames;              /* the passes of a full sort are divided over so many frames */
    uint32_t turn;                /* the part of the full sort that is next, from 0 to frames - 1 */
    bool started;                 /* false until the first sort, which runs all passes */
    GLuint pad_program, rank_program, slot_program, count_program, list_program;
    struct kiln_scan scan;
    struct kiln_buffer pairs, counts;
};

/* frames: 1 or more. kiln_kept_finish frees all resources, also after a failure. */
bool kiln_kept_init(struct kiln_kept *kept, struct kiln_device *device,
                    struct kiln_oddeven *oddeven, uint32_t frames, struct kiln_error *error);
void kiln_kept_finish(struct kiln_kept *kept);

/* Runs one frame's share of the passes, with keys from the particles and the camera as they are
 * now. Every call must pass the same pool. */
bool kiln_kept_sort(struct kiln_kept *kept, struct kiln_pool *pool, float3 eye, float3 forward,
                    struct kiln_error *error);

/* Save and restore the order between two sorts, and `turn`, the part of a sort that comes next:
 * KILN_SORT_NOT_BEGUN before the first. slots has room for the pool's slot_count. Restoring fails
 * with KILN_INVALID_INPUT for slots that the pool does not have. */
bool kiln_kept_save(struct kiln_kept *kept, const struct kiln_pool *pool, uint32_t *slots,
                    uint32_t *turn, struct kiln_error *error);
bool kiln_kept_restore(struct kiln_kept *kept, const struct kiln_pool *pool, const uint32_t *slots,
                       uint32_t turn, struct kiln_error *error);

/* Does the same as kiln_sort_run, but in the kept order without sorting it. It does not support
 * KILN_SORT_BY_SERIAL. */
bool kiln_kept_list(struct kiln_kept *kept, struct kiln_pool *pool,
                    const struct kiln_sort_params *params, struct kiln_buffer *entries,
                    uint32_t *count, struct kiln_error *error);

#endif
