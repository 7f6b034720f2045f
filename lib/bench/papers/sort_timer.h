/* Times sorts of given keys for benchmarks: by the techniques of the stage `sort`, and by the
 * variants of bitonic sorting that UberFlow's table 1 compares. */
#ifndef KILN_BENCH_PAPERS_SORT_TIMER_H
#define KILN_BENCH_PAPERS_SORT_TIMER_H

#include "base/thread.h"
#include "gpu/device.h"

enum kiln_sort_timer_kind {
    KILN_SORT_TIMER_CPU,
    KILN_SORT_TIMER_RADIX,
    KILN_SORT_TIMER_BITONIC,
    KILN_SORT_TIMER_ODDEVEN,
    KILN_SORT_TIMER_COMPUTED, /* UberFlow's FP (bitonic_field.h) */
    KILN_SORT_TIMER_PASSED,   /* UberFlow's GP/FP */
    KILN_SORT_TIMER_PACKED,   /* UberFlow's GP/FP Packed */
    KILN_SORT_TIMER_COUNT
};

/* Returns "cpu", "radix", "bitonic", "oddeven", "bitonic-computed", "bitonic-passed" or
 * "bitonic-packed". */
const char *kiln_sort_timer_name(enum kiln_sort_timer_kind kind);

struct kiln_sort_timer;

/* Creates a timer for up to `most` keys. device may be NULL for `cpu`; threads, which are borrowed,
 * may be NULL for all other kinds. Returns NULL with an error: KILN_USAGE without a device that is
 * needed, or KILN_DEVICE_FAILED. */
struct kiln_sort_timer *kiln_sort_timer_create(struct kiln_device *device,
                                               struct kiln_threads *threads,
                                               enum kiln_sort_timer_kind kind, uint32_t most,
                                               struct kiln_error *error);
void kiln_sort_timer_destroy(struct kiln_sort_timer **timer);

/* Makes later runs sort only within sets of `rows` rows of a square of keys, a power of two; 0: the
 * whole square. Has an effect on the three variants of bitonic sorting only. */
void kiln_sort_timer_restrict(struct kiln_sort_timer *timer, uint32_t rows);

/* Sorts the keys in ascending order. *ms is the time from prepared pairs (key, place) to the sorted
 * list of places; the list lies where the technique runs. */
bool kiln_sort_timer_run(struct kiln_sort_timer *timer, const uint32_t *keys, uint32_t count,
                         double *ms, struct kiln_error *error);

/* Returns the places of the keys of the last run in sorted order; NULL with an error. */
const uint32_t *kiln_sort_timer_places(struct kiln_sort_timer *timer, struct kiln_error *error);

#endif
