/* Declares what a technique of the sort stage is: a row of the table in sort.c. The file of each
 * technique ends with its row. */
#ifndef KILN_SORT_ROW_H
#define KILN_SORT_ROW_H

#include "sort/sort.h"

struct kiln_sort_row {
    bool in_gl; /* the technique needs a device that computes exactly */
    void *(*create)(const struct kiln_sort_setup *setup, struct kiln_error *error);
    void (*destroy)(void *technique);
    /* Does the same as kiln_sort_run. */
    bool (*run)(void *technique, struct kiln_pool *pool, const struct kiln_sort_params *params,
                struct kiln_buffer *entries, uint32_t *count, struct kiln_error *error);
    /* Returns the same as kiln_sort_bytes. */
    uint64_t (*bytes)(uint32_t slots);
    const struct kiln_history_kind *history; /* NULL: each list depends on one moment alone */
};

#endif
