/* This file runs technique `cpu` in host threads: it lists the living particles by serial, or runs
 * the sort by depth (depth.c). */
#include "sort/cpu.h"

#include <stdlib.h>

#include "base/error.h"
#include "sort/depth.h"

enum {
    MIN_BLOCK_SIZE = 8192,
    BLOCKS_A_THREAD = 4, /* more than one, so that a thread that begins late takes fewer */
};

struct sorter {
    struct kiln_threads *threads;
    struct kiln_buffer blocks; /* struct kiln_sort_block */
    struct kiln_sort_depth *depth;
};

static void destroy(void *technique)
{
    struct sorter *sort = technique;
    kiln_sort_depth_destroy(&sort->depth);
    kiln_buffer_finish(&sort->blocks);
    free(sort);
}

static void *create(const struct kiln_sort_setup *setup, struct kiln_error *error)
{
    struct sorter *sort = calloc(1, sizeof *sort);
    if (!sort) {
        kiln_error_no_memory(error, "the sort");
        return NULL;
    }
    sort->threads = setup->threads;
    kiln_buffer_init(&sort->blocks, NULL, 0, "blocks of slots");
    sort->depth = kiln_sort_depth_create(setup->threads, error);
    if (sort->depth)
        return sort;
    destroy(sort);
    return NULL;
}

struct listing {
    const struct kiln_particle *records;
    struct kiln_sort_block *blocks; /* place: first the number of living particles, then the index
                                     * of their first entry */
    uint32_t *entries;
};

static void count_alive(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct listing *listing = context;
    for (size_t b = begin; b < end; b++) {
        struct kiln_sort_block *block = &listing->blocks[b];
        uint32_t alive_count = 0;
        for (uint32_t slot = block->first; slot < block->end; slot++)
            alive_count += particle_is_alive(listing->records[slot]);
        block->place = alive_count;
    }
}

static void list_entries(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct listing *listing = context;
    for (size_t b = begin; b < end; b++) {
        const struct kiln_sort_block *block = &listing->blocks[b];
        uint32_t *to = listing->entries + block->place;
        for (uint32_t slot = block->first; slot < block->end; slot++)
            if (particle_is_alive(listing->records[slot]))
                *to++ = KILN_ENTRY(block->system, slot);
    }
}

/* Appends blocks of at most `block_size` slots that cover slots first .. end - 1. Returns the new
 * count. */
static size_t append_blocks(struct kiln_sort_block *blocks, size_t count, uint32_t system,
                            uint32_t first, uint32_t end, uint32_t block_size)
{
    for (; first < end; first = blocks[count++].end) {
        const uint32_t left = end - first;
        blocks[count] = (struct kiln_sort_block){
            .system = system,
            .first = first,
            .end = left < block_size ? end : first + block_size,
        };
    }
    return count;
}

/* Cuts the used slots of the chosen systems into blocks, in the order of serials: from the oldest
 * slot in use to the end of the system's slots, then from their start. Returns NULL with an
 * error. */
static struct kiln_sort_block *make_blocks(struct sorter *sort, const struct kiln_pool *pool,
                                           uint64_t systems, size_t *count,
                                           struct kiln_error *error)
{
    *count = 0;
    const uint32_t shared =
        pool->slot_count / (BLOCKS_A_THREAD * kiln_threads_count(sort->threads)) + 1;
    const uint32_t block_size = shared > MIN_BLOCK_SIZE ? shared : MIN_BLOCK_SIZE;
    kiln_buffer_reserve(&sort->blocks,
                        (pool->slot_count / block_size + 2 * (size_t)KILN_MAX_SYSTEMS) *
                            sizeof(struct kiln_sort_block));
    struct kiln_sort_block *blocks = kiln_buffer_host(&sort->blocks, KILN_OVERWRITE, error);
    if (!blocks)
        return NULL;
    for (uint32_t i = 0; i < pool->system_count; i++) {
        const struct kiln_pool_system *system = &pool->systems[i];
        const uint32_t used = kiln_pool_used(system);
        if (used == 0 || !(systems >> i & 1))
            continue;
        const uint32_t oldest = (uint32_t)((system->next_serial - used) % system->capacity);
        const uint32_t base = system->base;
        *count = append_blocks(blocks, *count, i, base + oldest, base + used, block_size);
        *count = append_blocks(blocks, *count, i, base, base + oldest, block_size);
    }
    return blocks;
}

/* Replaces each block's number of living particles by the prefix sum, and returns the total. */
static uint32_t sum_blocks(struct kiln_sort_block *blocks, size_t count)
{
    uint32_t place = 0;
    for (size_t b = 0; b < count; b++) {
        uint32_t alive_count = blocks[b].place;
        blocks[b].place = place;
        place += alive_count;
    }
    return place;
}

static bool run(void *technique, struct kiln_pool *pool, const struct kiln_sort_params *params,
                struct kiln_buffer *entries, uint32_t *count, struct kiln_error *error)
{
    struct sorter *sort = technique;
    size_t block_count = 0;
    struct listing listing = {.records = kiln_buffer_host(&pool->records, KILN_READ, error)};
    listing.blocks = make_blocks(sort, pool, params->systems, &block_count, error);
    if (!listing.records || !listing.blocks)
        return false;
    if (params->order == KILN_SORT_BY_SERIAL) {
        listing.entries = kiln_buffer_host(entries, KILN_READ_WRITE, error);
        if (!listing.entries)
            return false;
        kiln_threads_for(sort->threads, block_count, 1, count_alive, &listing);
        *count = sum_blocks(listing.blocks, block_count);
        kiln_threads_for(sort->threads, block_count, 1, list_entries, &listing);
    } else if (!kiln_sort_depth_run(sort->depth, pool, params, listing.blocks, block_count, entries,
                                    count, error)) {
        return false;
    }
    kiln_buffer_set_content(entries, *count * sizeof(uint32_t));
    return true;
}

/* A slot takes a key and an entry, and twice that where cells of depth do not help. */
static uint64_t bytes(uint32_t slots)
{
    return 2 * sizeof(uint32_t) * (uint64_t)slots;
}

const struct kiln_sort_row kiln_sort_cpu_row = {
    .create = create, .destroy = destroy, .run = run, .bytes = bytes};
