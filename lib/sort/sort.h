/* Stage 3 lists the living particles in the order of drawing. All techniques give the same list; a
 * technique that is spread over frames gives it once its order has caught up with what moves.
 * Particles that only add light are listed by serials and not sorted. The technique `tiled` of
 * drawing takes the list from front to back. */
#ifndef KILN_SORT_SORT_H
#define KILN_SORT_SORT_H

#include "base/thread.h"
#include "particles/pool.h"

enum kiln_sort_technique { KILN_SORT_CPU, KILN_SORT_RADIX, KILN_SORT_BITONIC, KILN_SORT_ODDEVEN };

/* Frames that a sort can be spread over. */
enum { KILN_SORT_MAX_SPREAD = 64 };

struct kiln_sort;

enum kiln_sort_order {
    KILN_SORT_BY_SERIAL,     /* (system, serial): nothing is sorted */
    KILN_SORT_BACK_TO_FRONT, /* (view depth descending, system, serial) */
    KILN_SORT_FRONT_TO_BACK, /* the reverse of that, so equal depths by descending serials, too */
};

struct kiln_sort_params {
    float3 eye;       /* camera position, m */
    float3 forward;   /* view direction, unit length */
    uint32_t systems; /* bit i: system i takes part */
    enum kiln_sort_order order;
};

/* device may be NULL for `cpu`; threads are borrowed. KILN_USAGE when the technique needs what the
 * device does not have. */
struct kiln_sort *kiln_sort_create(struct kiln_device *device, enum kiln_sort_technique technique,
                                   struct kiln_threads *threads, struct kiln_error *error);

/* Makes a sort of technique `oddeven` that keeps an order from frame to frame and divides the
 * passes of a whole sort over `frames` frames: 1 to KILN_SORT_MAX_SPREAD. */
struct kiln_sort *kiln_sort_create_spread(struct kiln_device *device, uint32_t frames,
                                          struct kiln_threads *threads, struct kiln_error *error);
void kiln_sort_destroy(struct kiln_sort **sort);

/* Returns whether the list depends on earlier frames. If so, kiln_sort_follow must be called in
 * turn for each moment that could be drawn, drawn or not. */
bool kiln_sort_keeps_history(const struct kiln_sort *sort);

/* Sorts a kept order for the next moment, always of the same pool; call it before kiln_sort_run,
 * which then lists in this order. Has no effect without history. params->systems and ->order do not
 * matter. */
bool kiln_sort_follow(struct kiln_sort *sort, struct kiln_pool *pool,
                      const struct kiln_sort_params *params, struct kiln_error *error);

/* Saves and restores the order that is kept: all slots of the pool, and which part of a sort comes
 * next. Only for sorts that keep history. Restoring refuses slots that the pool does not have, with
 * KILN_INVALID_INPUT. */
#define KILN_SORT_NOT_BEGUN UINT32_MAX
bool kiln_sort_save(struct kiln_sort *sort, const struct kiln_pool *pool, uint32_t *slots,
                    uint32_t *turn, struct kiln_error *error);
bool kiln_sort_restore(struct kiln_sort *sort, const struct kiln_pool *pool, const uint32_t *slots,
                       uint32_t turn, struct kiln_error *error);

/* Fills entries with the draw entries of the living particles of the chosen systems in the order
 * that is asked for, and counts them. entries has room for the pool's slot_count; a technique may
 * make it twice as large, to sort in it. Where the technique runs on the device, so do records and
 * entries; the count alone is read back. */
bool kiln_sort_run(struct kiln_sort *sort, struct kiln_pool *pool,
                   const struct kiln_sort_params *params, struct kiln_buffer *entries,
                   uint32_t *count, struct kiln_error *error);

/* Returns the bytes that sorting so many slots takes in all, the list of entries included: the two
 * or three buffers that grow with them. spread: of an order that is kept. */
uint64_t kiln_sort_bytes(enum kiln_sort_technique technique, bool spread, uint32_t slots);

#endif
