/* Lists the living, gives each a key that grows towards the camera, and sorts. */
#include "sort/cpu.h"

#include <stdlib.h>

#include "base/error.h"
#include "shared/keys.h"
#include "sort/pairs.h"

enum { ENTRIES_AT_A_TIME = 8192 };

struct kiln_sort_cpu {
    struct kiln_threads *threads;
    size_t capacity;                 /* of the arrays */
    kiln_sort_pair *pairs, *scratch; /* (depth key, entry) */
    uint32_t *counts;
};

struct kiln_sort_cpu *kiln_sort_cpu_create(struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_sort_cpu *sort = calloc(1, sizeof *sort);
    if (sort)
        sort->counts = malloc(kiln_sort_count_words(threads) * sizeof *sort->counts);
    if (!sort || !sort->counts) {
        free(sort);
        kiln_error_set(error, KILN_DEVICE_FAILED, "sort: no memory");
        return NULL;
    }
    sort->threads = threads;
    return sort;
}

void kiln_sort_cpu_destroy(struct kiln_sort_cpu **sort)
{
    if (!*sort)
        return;
    free((*sort)->pairs);
    free((*sort)->scratch);
    free((*sort)->counts);
    free(*sort);
    *sort = NULL;
}

static bool reserve(struct kiln_sort_cpu *sort, size_t capacity, struct kiln_error *error)
{
    if (capacity <= sort->capacity)
        return true;
    free(sort->pairs);
    free(sort->scratch);
    sort->pairs = malloc(capacity * sizeof *sort->pairs);
    sort->scratch = malloc(capacity * sizeof *sort->scratch);
    sort->capacity = sort->pairs && sort->scratch ? capacity : 0;
    if (sort->capacity == 0)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "sort: no memory for %zu particles",
                              capacity);
    return true;
}

/* Keeps the entries of the chosen systems, in order. */
static uint32_t choose(uint32_t *entries, uint32_t count, uint32_t systems)
{
    uint32_t chosen = 0;
    for (uint32_t i = 0; i < count; i++) {
        entries[chosen] = entries[i];
        chosen += systems >> KILN_ENTRY_SYSTEM(entries[i]) & 1u;
    }
    return chosen;
}

struct key_work {
    const struct kiln_sort_params *params;
    const struct kiln_particle *records;
    uint32_t *entries;
    kiln_sort_pair *pairs;
    size_t count;
};

static void make_keys(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct key_work *work = context;
    for (size_t i = begin; i < end; i++) {
        uint32_t entry = work->entries[i];
        struct kiln_particle p = work->records[KILN_ENTRY_SLOT(entry)];
        uint32_t key = key_of_particle(p, work->params->eye, work->params->forward);
        work->pairs[i] = (kiln_sort_pair)key << 32 | entry;
    }
}

static void take_entries(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct key_work *work = context;
    bool reverse = work->params->order == KILN_SORT_FRONT_TO_BACK;
    for (size_t i = begin; i < end; i++)
        work->entries[reverse ? work->count - 1 - i : i] = (uint32_t)work->pairs[i];
}

bool kiln_sort_cpu_run(struct kiln_sort_cpu *sort, struct kiln_pool *pool,
                       const struct kiln_sort_params *params, struct kiln_buffer *entries,
                       uint32_t *count, struct kiln_error *error)
{
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    uint32_t *list = kiln_buffer_host(entries, KILN_READ_WRITE, error);
    if (!records || !list)
        return false;
    *count = choose(list, kiln_pool_alive(pool, records, list), params->systems);
    if (params->order == KILN_SORT_BY_SERIAL)
        return true;
    if (!reserve(sort, *count, error))
        return false;
    struct key_work work = {params, records, list, sort->pairs, *count};
    kiln_threads_for(sort->threads, *count, ENTRIES_AT_A_TIME, make_keys, &work);
    work.pairs = kiln_sort_pairs(sort->threads, sort->pairs, sort->scratch, *count, sort->counts);
    kiln_threads_for(sort->threads, *count, ENTRIES_AT_A_TIME, take_entries, &work);
    return true;
}
