/* This file runs the sort stage by the technique that was chosen for it. */
#include "sort/sort.h"

#include <stdlib.h>

#include "base/error.h"
#include "sort/bitonic.h"
#include "sort/cpu.h"
#include "sort/radix.h"
#include "sort/spread.h"

struct kiln_sort {
    enum kiln_sort_technique technique;
    struct kiln_sort_cpu *cpu;
    struct kiln_radix *radix;
    struct kiln_bitonic *bitonic;
    struct kiln_oddeven *oddeven;
    bool is_spread; /* the sort is spread over frames and uses `spread` */
    struct kiln_sort_spread spread;
};

static bool create_technique(struct kiln_sort *sort, struct kiln_device *device,
                             struct kiln_threads *threads, struct kiln_error *error)
{
    if (sort->technique == KILN_SORT_CPU) {
        sort->cpu = kiln_sort_cpu_create(threads, error);
        return sort->cpu != NULL;
    }
    if (!device)
        return kiln_error_set(error, KILN_USAGE, "this sort needs a device; use sort=cpu");
    if (!device->info.exact)
        return kiln_error_set(error, KILN_USAGE,
                              "%s computes inexactly and cannot sort; use sort=cpu",
                              device->info.name);
    if (sort->technique == KILN_SORT_RADIX)
        sort->radix = kiln_radix_create(device, error);
    else if (sort->technique == KILN_SORT_BITONIC)
        sort->bitonic = kiln_bitonic_create(device, error);
    else
        sort->oddeven = kiln_oddeven_create(device, error);
    return sort->radix || sort->bitonic || sort->oddeven;
}

struct kiln_sort *kiln_sort_create(struct kiln_device *device, enum kiln_sort_technique technique,
                                   struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_sort *sort = calloc(1, sizeof *sort);
    if (!sort) {
        kiln_error_no_memory(error, "the sort");
        return NULL;
    }
    sort->technique = technique;
    if (!create_technique(sort, device, threads, error))
        kiln_sort_destroy(&sort);
    return sort;
}

struct kiln_sort *kiln_sort_create_spread(struct kiln_device *device, uint32_t frames,
                                          struct kiln_threads *threads, struct kiln_error *error)
{
    if (frames < 1 || frames > KILN_SORT_MAX_SPREAD) {
        kiln_error_set(error, KILN_USAGE, "a sort can be spread over 1 to %d frames, not %u",
                       KILN_SORT_MAX_SPREAD, frames);
        return NULL;
    }
    struct kiln_sort *sort = kiln_sort_create(device, KILN_SORT_ODDEVEN, threads, error);
    if (!sort)
        return NULL;
    sort->is_spread = true;
    if (!kiln_sort_spread_init(&sort->spread, device, sort->oddeven, frames, error))
        kiln_sort_destroy(&sort);
    return sort;
}

void kiln_sort_destroy(struct kiln_sort **sort)
{
    if (!*sort)
        return;
    if ((*sort)->is_spread)
        kiln_sort_spread_finish(&(*sort)->spread);
    kiln_oddeven_destroy(&(*sort)->oddeven);
    kiln_sort_cpu_destroy(&(*sort)->cpu);
    kiln_radix_destroy(&(*sort)->radix);
    kiln_bitonic_destroy(&(*sort)->bitonic);
    free(*sort);
    *sort = NULL;
}

uint64_t kiln_sort_bytes(enum kiln_sort_technique technique, bool spread, uint32_t slots)
{
    const uint64_t pair = 8, word = 4;
    const uint64_t padded = kiln_network_padded(slots) * pair;
    switch (technique) {
    case KILN_SORT_CPU: /* a key and an entry; twice that where cells of depth do not help */
        return pair * slots;
    case KILN_SORT_RADIX:
        return 2 * pair * slots; /* the pairs twice; the list overwrites one of the copies */
    case KILN_SORT_BITONIC:
        break;
    case KILN_SORT_ODDEVEN:
        if (spread)
            return padded + word * slots;
        break;
    }
    return padded + 2 * word * slots; /* the pairs, the unsorted list and the sorted list */
}

bool kiln_sort_keeps_history(const struct kiln_sort *sort)
{
    return sort->is_spread;
}

bool kiln_sort_advance(struct kiln_sort *sort, struct kiln_pool *pool,
                       const struct kiln_sort_params *params, struct kiln_error *error)
{
    return !sort->is_spread ||
           kiln_sort_spread_advance(&sort->spread, pool, params->eye, params->forward, error);
}

bool kiln_sort_save(struct kiln_sort *sort, const struct kiln_pool *pool, uint32_t *slots,
                    uint32_t *next_part, struct kiln_error *error)
{
    return kiln_sort_spread_save(&sort->spread, pool, slots, next_part, error);
}

bool kiln_sort_restore(struct kiln_sort *sort, const struct kiln_pool *pool, const uint32_t *slots,
                       uint32_t next_part, struct kiln_error *error)
{
    return kiln_sort_spread_restore(&sort->spread, pool, slots, next_part, error);
}

bool kiln_sort_run(struct kiln_sort *sort, struct kiln_pool *pool,
                   const struct kiln_sort_params *params, struct kiln_buffer *entries,
                   uint32_t *count, struct kiln_error *error)
{
    switch (sort->technique) {
    case KILN_SORT_CPU:
        return kiln_sort_cpu_run(sort->cpu, pool, params, entries, count, error);
    case KILN_SORT_RADIX:
        return kiln_radix_run(sort->radix, pool, params, entries, count, error);
    case KILN_SORT_BITONIC:
        return kiln_network_run(kiln_bitonic_network(sort->bitonic), pool, params, entries, count,
                                error);
    case KILN_SORT_ODDEVEN:
        if (sort->is_spread && params->order != KILN_SORT_BY_SERIAL)
            return kiln_sort_spread_list(&sort->spread, pool, params, entries, count, error);
        return kiln_network_run(kiln_oddeven_network(sort->oddeven), pool, params, entries, count,
                                error);
    }
    return false;
}
