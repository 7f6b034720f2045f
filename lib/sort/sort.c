/* This file has the table of the sort techniques, and runs the sort stage by the technique that was
 * chosen for it. */
#include "sort/sort.h"

#include <stdlib.h>

#include "base/error.h"
#include "sort/bitonic.h"
#include "sort/cpu.h"
#include "sort/papers/papers.h"
#include "sort/radix.h"

static const struct kiln_sort_row *const ROWS[] = {
    [KILN_SORT_CPU] = &kiln_sort_cpu_row,         [KILN_SORT_RADIX] = &kiln_sort_radix_row,
    [KILN_SORT_BITONIC] = &kiln_sort_bitonic_row, [KILN_SORT_ODDEVEN] = &kiln_sort_oddeven_row,
    [KILN_SORT_SPREAD] = &kiln_sort_spread_row,
};

struct kiln_sort {
    const struct kiln_sort_row *row;
    void *technique; /* what the row created */
};

static bool check_device(const struct kiln_sort_row *row, const struct kiln_device *device,
                         struct kiln_error *error)
{
    if (!row->in_gl)
        return true;
    if (!device)
        return kiln_error_set(error, KILN_USAGE, "this sort needs a device; use sort=cpu");
    return device->info.exact ||
           kiln_error_set(error, KILN_USAGE, "%s computes inexactly and cannot sort; use sort=cpu",
                          device->info.name);
}

struct kiln_sort *kiln_sort_create(enum kiln_sort_technique technique,
                                   const struct kiln_sort_setup *setup, struct kiln_error *error)
{
    if (!check_device(ROWS[technique], setup->device, error))
        return NULL;
    struct kiln_sort *sort = calloc(1, sizeof *sort);
    if (!sort) {
        kiln_error_no_memory(error, "the sort");
        return NULL;
    }
    sort->row = ROWS[technique];
    sort->technique = sort->row->create(setup, error);
    if (!sort->technique)
        kiln_sort_destroy(&sort);
    return sort;
}

void kiln_sort_destroy(struct kiln_sort **sort)
{
    if (!*sort)
        return;
    if ((*sort)->technique)
        (*sort)->row->destroy((*sort)->technique);
    free(*sort);
    *sort = NULL;
}

uint64_t kiln_sort_bytes(enum kiln_sort_technique technique, uint32_t slots)
{
    return ROWS[technique]->bytes(slots);
}

bool kiln_sort_keeps_history(enum kiln_sort_technique technique)
{
    return ROWS[technique]->history != NULL;
}

struct kiln_history kiln_sort_history(struct kiln_sort *sort)
{
    return (struct kiln_history){.kind = sort->row->history, .technique = sort->technique};
}

bool kiln_sort_run(struct kiln_sort *sort, struct kiln_pool *pool,
                   const struct kiln_sort_params *params, struct kiln_buffer *entries,
                   uint32_t *count, struct kiln_error *error)
{
    return sort->row->run(sort->technique, pool, params, entries, count, error);
}
