/* The sort stage, stage 3 of a frame, lists the living particles in the order of drawing. All
 * techniques give the same list; a sort that is spread over frames gives it once its order has
 * caught up with the movement of particles and camera. Additive particles are listed by serial and
 * not sorted. The draw technique `tiled` takes the list from front to back. */
#ifndef KILN_SORT_SORT_H
#define KILN_SORT_SORT_H

#include "base/thread.h"
#include "particles/pool.h"

enum kiln_sort_technique { KILN_SORT_CPU, KILN_SORT_RADIX, KILN_SORT_BITONIC, KILN_SORT_ODDEVEN };

/* The greatest number of frames that a sort can be spread over. */
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

/* Creates a sort. device may be NULL for KILN_SORT_CPU; the threads are borrowed. Fails with
 * KILN_USAGE when another technique gets no device or one that does not compute exactly. */
struct kiln_sort *kiln_sort_create(struct kiln_device *device, enum kiln_sort_technique technique,
                                   struct kiln_threads *threads, struct kiln_error *error);

/* Creates a sort of technique `oddeven` that keeps an order from frame to frame and divides the
 * passes of a full sort over `frames` frames: 1 to KILN_SORT_MAX_SPREAD. */
struct kiln_sort *kiln_sort_create_spread(struct kiln_device *device, uint32_t frames,
                                          struct kiln_threads *threads, struct kiln_error *error);
void kiln_sort_destroy(struct kiln_sort **sort);

/* Returns whether the list depends on earlier frames. If so, kiln_sort_advance must be called in
 * order for each moment that could be drawn, even if that moment is not drawn. */
bool kiln_sort_keeps_history(const struct kiln_sort *sort);

/* Runs the next part of sorting the kept order; kiln_sort_run then lists particles in this order.
 * Every call must pass a pool with the same slots. Has no effect on a sort that keeps no history.
 * Ignores params->systems and params->order. */
bool kiln_sort_advance(struct kiln_sort *sort, struct kiln_pool *pool,
                       const struct kiln_sort_params *params, struct kiln_error *error);

/* Save and restore the kept order, which consists of all slots of the pool and the part of a sort
 * that comes next (next_part). They are only for sorts that keep history. Restoring fails with
 * KILN_INVALID_INPUT for slots that the pool does not have. */
#define KILN_SORT_NOT_BEGUN UINT32_MAX
bool kiln_sort_save(struct kiln_sort *sort, const struct kiln_pool *pool, uint32_t *slots,
                    uint32_t *next_part, struct kiln_error *error);
bool kiln_sort_restore(struct kiln_sort *sort, const struct kiln_pool *pool, const uint32_t *slots,
                       uint32_t next_part, struct kiln_error *error);

/* Fills entries with the draw entries of the living particles of the chosen systems in the order
 * params->order, and counts them. entries has room for the pool's slot_count; a technique may make
 * it twice as large, to sort in it. If the technique runs on the device, records and entries stay
 * there, and only the count is read back. */
bool kiln_sort_run(struct kiln_sort *sort, struct kiln_pool *pool,
                   const struct kiln_sort_params *params, struct kiln_buffer *entries,
                   uint32_t *count, struct kiln_error *error);

/* Returns the size in bytes of the buffers that grow with the number of slots, the list of entries
 * included. spread: the sort comes from kiln_sort_create_spread. */
uint64_t kiln_sort_bytes(enum kiln_sort_technique technique, bool spread, uint32_t slots);

#endif
