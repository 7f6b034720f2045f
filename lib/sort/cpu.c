/* Lists the living with keys that grow towards the camera, and sorts. What the sort needs is the
 * pairs twice, 16 bytes a particle: the list takes the place of one of them. */
#include "sort/cpu.h"

#include <stdlib.h>

#include "base/error.h"
#include "shared/keys.h"
#include "sort/pairs.h"

enum { SLOTS_AT_A_TIME = 8192 };

struct kiln_sort_cpu {
    struct kiln_threads *threads;
    struct kiln_buffer pairs;  /* (depth key, entry) */
    struct kiln_buffer blocks; /* of slots: struct block */
    uint32_t *counts;          /* of the sort */
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
    kiln_buffer_init(&sort->pairs, NULL, 0, "sort pairs");
    kiln_buffer_init(&sort->blocks, NULL, 0, "blocks of slots");
    return sort;
}

void kiln_sort_cpu_destroy(struct kiln_sort_cpu **sort)
{
    if (!*sort)
        return;
    kiln_buffer_finish(&(*sort)->pairs);
    kiln_buffer_finish(&(*sort)->blocks);
    free((*sort)->counts);
    free(*sort);
    *sort = NULL;
}

/* Slots of one system that follow one another by serial. */
struct block {
    uint32_t system;
    uint32_t first, end; /* slots of the pool */
    uint32_t place;      /* first how many live, then where they are listed */
    struct kiln_sort_span span;
};

struct listing {
    const struct kiln_sort_params *params;
    const struct kiln_particle *records;
    struct block *blocks;
    uint32_t *entries;     /* the list alone, */
    kiln_sort_pair *pairs; /* or with keys */
};

static void count_living(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct listing *listing = context;
    for (size_t b = begin; b < end; b++) {
        struct block *block = &listing->blocks[b];
        uint32_t living = 0;
        for (uint32_t slot = block->first; slot < block->end; slot++)
            living += particle_is_alive(listing->records[slot]);
        block->place = living;
    }
}

static void list_entries(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct listing *listing = context;
    for (size_t b = begin; b < end; b++) {
        const struct block *block = &listing->blocks[b];
        uint32_t *to = listing->entries + block->place;
        for (uint32_t slot = block->first; slot < block->end; slot++)
            if (particle_is_alive(listing->records[slot]))
                *to++ = KILN_ENTRY(block->system, slot);
    }
}

static void list_pairs(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct listing *listing = context;
    const float3 eye = listing->params->eye, forward = listing->params->forward;
    for (size_t b = begin; b < end; b++) {
        struct block *block = &listing->blocks[b];
        struct kiln_sort_span span = {UINT32_MAX, 0};
        kiln_sort_pair *to = listing->pairs + block->place;
        for (uint32_t slot = block->first; slot < block->end; slot++) {
            struct kiln_particle p = listing->records[slot];
            if (!particle_is_alive(p))
                continue;
            uint32_t key = key_of_particle(p, eye, forward);
            *to++ = (kiln_sort_pair)key << 32 | KILN_ENTRY(block->system, slot);
            span.least = key < span.least ? key : span.least;
            span.greatest = key > span.greatest ? key : span.greatest;
        }
        block->span = span;
    }
}

/* Cuts slots first .. end - 1 into blocks. */
static size_t cut(struct block *blocks, size_t count, uint32_t system, uint32_t first, uint32_t end)
{
    for (; first < end; first = blocks[count++].end) {
        uint32_t left = end - first;
        blocks[count] = (struct block){
            .system = system,
            .first = first,
            .end = left < SLOTS_AT_A_TIME ? end : first + SLOTS_AT_A_TIME,
        };
    }
    return count;
}

/* The used slots of the chosen systems in the order of serials: from the oldest that may still have
 * its slot to the end, then from the start. NULL with an error. */
static struct block *make_blocks(struct kiln_sort_cpu *sort, const struct kiln_pool *pool,
                                 uint32_t systems, size_t *count, struct kiln_error *error)
{
    *count = 0;
    kiln_buffer_reserve(&sort->blocks,
                        (pool->slot_count / SLOTS_AT_A_TIME + 2 * (size_t)KILN_MAX_SYSTEMS) *
                            sizeof(struct block));
    struct block *blocks = kiln_buffer_host(&sort->blocks, KILN_OVERWRITE, error);
    if (!blocks)
        return NULL;
    for (uint32_t i = 0; i < pool->system_count; i++) {
        const struct kiln_pool_system *system = &pool->systems[i];
        const uint32_t used = kiln_pool_used(system);
        if (used == 0 || !(systems >> i & 1u))
            continue;
        const uint32_t oldest = (uint32_t)((system->next_serial - used) % system->capacity);
        *count = cut(blocks, *count, i, system->base + oldest, system->base + used);
        *count = cut(blocks, *count, i, system->base, system->base + oldest);
    }
    return blocks;
}

/* Turns numbers into places and returns how many there are in all. */
static uint32_t sum_blocks(struct block *blocks, size_t count)
{
    uint32_t place = 0;
    for (size_t b = 0; b < count; b++) {
        uint32_t living = blocks[b].place;
        blocks[b].place = place;
        place += living;
    }
    return place;
}

static struct kiln_sort_span span_of(const struct block *blocks, size_t count)
{
    struct kiln_sort_span span = {UINT32_MAX, 0};
    for (size_t b = 0; b < count; b++) {
        const struct kiln_sort_span *of = &blocks[b].span;
        span.least = of->least < span.least ? of->least : span.least;
        span.greatest = of->greatest > span.greatest ? of->greatest : span.greatest;
    }
    return span;
}

bool kiln_sort_cpu_run(struct kiln_sort_cpu *sort, struct kiln_pool *pool,
                       const struct kiln_sort_params *params, struct kiln_buffer *entries,
                       uint32_t *count, struct kiln_error *error)
{
    size_t block_count = 0;
    struct listing listing = {.params = params};
    listing.records = kiln_buffer_host(&pool->records, KILN_READ, error);
    listing.blocks = make_blocks(sort, pool, params->systems, &block_count, error);
    if (!listing.records || !listing.blocks)
        return false;
    kiln_threads_for(sort->threads, block_count, 1, count_living, &listing);
    *count = sum_blocks(listing.blocks, block_count);
    const bool sorts = params->order != KILN_SORT_BY_SERIAL;
    if (sorts) {
        kiln_buffer_reserve(entries, pool->slot_count * sizeof(kiln_sort_pair));
        kiln_buffer_reserve(&sort->pairs, pool->slot_count * sizeof(kiln_sort_pair));
        listing.pairs = kiln_buffer_host(&sort->pairs, KILN_OVERWRITE, error);
    }
    listing.entries = kiln_buffer_host(entries, KILN_READ_WRITE, error);
    if (!listing.entries || (sorts && !listing.pairs))
        return false;
    kiln_threads_for(sort->threads, block_count, 1, sorts ? list_pairs : list_entries, &listing);
    if (sorts)
        kiln_sort_pairs(sort->threads, listing.pairs, *count, span_of(listing.blocks, block_count),
                        params->order == KILN_SORT_FRONT_TO_BACK, listing.entries, sort->counts);
    kiln_buffer_set_content(entries, *count * sizeof *listing.entries);
    return true;
}
