/* This file computes keys and cells of particles for the sort by depth and distributes draw entries
 * to cells. It processes LANES particles at a time in loops without branches, which compilers
 * vectorise. Only the stores of pairs and entries are made one by one. */
#include <string.h>

#include "particles/pool.h"
#include "sort/cells.h"

enum {
    LANES = 128,
    AHEAD = 128,    /* how many records ahead the loop prefetches */
    RECORD_LINE = 2 /* records in a cache line */
};

/* Returns the depth of a key; the inverse of key_of_depth. */
static inline float depth_of_key(uint32_t key)
{
    const uint32_t behind = 0u - (key >> 31); /* all ones where the key is the bits of the depth */
    return BITS_FLOAT((key ^ ~behind) & (behind | EXACT_SIZE_BITS));
}

/* Returns the cell of a key. The result does not decrease when the key grows, since subtracting,
 * multiplying and rounding keep the order. */
static inline uint32_t cell_of(const struct kiln_sort_cells *cells, uint32_t key)
{
    float x = (cells->far_edge_m - depth_of_key(key)) * cells->cells_per_m;
    float last = (float)(cells->count - 1);
    x = x > 0.0f ? x : 0.0f;
    return (uint32_t)(int32_t)(x < last ? x : last);
}

struct lanes {
    uint32_t x[LANES], y[LANES], z[LANES], births[LANES]; /* words of records */
    uint32_t keys[LANES], alive[LANES];
};

/* Computes the keys of `count` particles, at most LANES. Others of the lanes count as dead. */
static inline void find_keys(const struct kiln_sort_slots *slots, uint32_t first, uint32_t count,
                             struct lanes *lanes)
{
    const struct kiln_particle *records = slots->records + first;
    struct kiln_particle tail[LANES];
    for (uint32_t i = AHEAD; i < AHEAD + LANES && i < slots->end - first; i += RECORD_LINE)
        __builtin_prefetch(records + i);
    if (count < LANES) {
        memset(tail, 0, sizeof tail);
        memcpy(tail, records, count * sizeof *tail);
        records = tail;
    }
    for (uint32_t i = 0; i < LANES; i++) {
        lanes->x[i] = records[i].position_serial.x;
        lanes->y[i] = records[i].position_serial.y;
        lanes->z[i] = records[i].position_serial.z;
        lanes->births[i] = records[i].velocity_birth.w;
    }
    for (uint32_t i = 0; i < LANES; i++) {
        const struct kiln_particle p = {
            .position_serial = {lanes->x[i], lanes->y[i], lanes->z[i], 0},
            .velocity_birth = {0, 0, 0, lanes->births[i]},
        };
        lanes->keys[i] = key_of_particle(p, slots->eye, slots->forward);
        lanes->alive[i] = particle_is_alive(p);
    }
}

static inline uint32_t lanes_from(const struct kiln_sort_slots *slots, uint32_t first)
{
    return slots->end - first < LANES ? slots->end - first : LANES;
}

__attribute__((flatten)) static void count(const struct kiln_sort_slots *slots,
                                           const struct kiln_sort_cells *cells, uint32_t *keys,
                                           uint32_t *counts)
{
    const struct kiln_sort_slots range = *slots;
    const struct kiln_sort_cells layout = *cells;
    struct lanes lanes;
    uint32_t cell[LANES];
    for (uint32_t first = range.first; first < range.end; first += LANES) {
        const uint32_t lane_count = lanes_from(&range, first);
        find_keys(&range, first, lane_count, &lanes);
        for (uint32_t i = 0; i < LANES; i++) {
            const uint32_t dead = lanes.alive[i] - 1u;
            cell[i] = (cell_of(&layout, lanes.keys[i]) & ~dead) | (layout.count & dead);
            lanes.keys[i] = (lanes.keys[i] & ~dead) | (KILN_SORT_DEAD & dead);
        }
        memcpy(keys + first, lanes.keys, lane_count * sizeof *keys);
        for (uint32_t i = 0; i < lane_count && layout.count > 1; i++)
            counts[cell[i]]++;
    }
}

__attribute__((flatten)) static void scatter(const struct kiln_sort_slots *slots,
                                             const struct kiln_sort_cells *cells,
                                             const uint32_t *keys, uint32_t *places,
                                             uint32_t *entries)
{
    const struct kiln_sort_cells layout = *cells;
    uint32_t cell[LANES];
    for (uint32_t first = slots->first; first < slots->end; first += LANES) {
        const uint32_t lane_count = lanes_from(slots, first);
        const uint32_t first_entry = KILN_ENTRY(slots->system, first);
        for (uint32_t i = 0; i < lane_count; i++) {
            const uint32_t key = keys[first + i];
            const uint32_t of_living = cell_of(&layout, key);
            cell[i] = key == KILN_SORT_DEAD ? layout.count : of_living;
        }
        for (uint32_t i = 0; i < lane_count; i++)
            entries[places[cell[i]]++] = first_entry + i;
    }
}

static struct kiln_sort_span pair(const uint32_t *entries, size_t entry_count, size_t fetch_count,
                                  const uint32_t *keys, kiln_sort_pair *pairs)
{
    uint32_t least = UINT32_MAX, greatest = 0;
    for (size_t first = 0; first < entry_count; first += LANES) {
        const size_t end = entry_count - first < LANES ? entry_count : first + LANES;
        for (size_t i = first + LANES; i < first + 2 * (size_t)LANES && i < fetch_count; i++)
            __builtin_prefetch(&keys[KILN_ENTRY_SLOT(entries[i])]);
        for (size_t i = first; i < end; i++) {
            const uint32_t key = keys[KILN_ENTRY_SLOT(entries[i])];
            pairs[i] = (kiln_sort_pair)key << 32 | entries[i];
            least = key < least ? key : least;
            greatest = key > greatest ? key : greatest;
        }
    }
    return (struct kiln_sort_span){least, greatest};
}

static size_t list(const struct kiln_sort_slots *slots, const uint32_t *keys, kiln_sort_pair *pairs,
                   struct kiln_sort_span *span)
{
    kiln_sort_pair *to = pairs;
    uint32_t least = span->least, greatest = span->greatest;
    for (uint32_t slot = slots->first; slot < slots->end; slot++) {
        const uint32_t key = keys[slot], dead = key == KILN_SORT_DEAD ? UINT32_MAX : 0;
        const uint32_t low = key | dead;
        *to = (kiln_sort_pair)key << 32 | KILN_ENTRY(slots->system, slot);
        to += key != KILN_SORT_DEAD;
        least = low < least ? low : least;
        greatest = key > greatest ? key : greatest;
    }
    *span = (struct kiln_sort_span){least, greatest};
    return (size_t)(to - pairs);
}

const struct kiln_sort_loops KILN_SIMD_NAME(kiln_sort_loops) = {
    .count = count, .scatter = scatter, .pair = pair, .list = list};
