/* This file computes keys and cells of particles for the sort by depth and distributes pairs to
 * cells. It processes LANES particles at a time in loops without branches, which compilers
 * vectorise. Only the stores of pairs are made one by one. */
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
    uint32_t keys[LANES], cells[LANES], alive[LANES];
};

/* Computes keys and cells. A dead particle gets the cell behind the last one. */
static inline void find_keys(const struct kiln_particle *records, float3 eye, float3 forward,
                             const struct kiln_sort_cells *cells, struct lanes *lanes)
{
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
        lanes->keys[i] = key_of_particle(p, eye, forward);
        lanes->alive[i] = particle_is_alive(p);
    }
    for (uint32_t i = 0; i < LANES; i++) {
        const uint32_t dead = lanes->alive[i] - 1u;
        const uint32_t cell = cell_of(cells, lanes->keys[i]);
        lanes->cells[i] = (cell & ~dead) | (cells->count & dead);
    }
}

static inline void widen(struct kiln_sort_span *span, const struct lanes *lanes)
{
    uint32_t least = span->least, greatest = span->greatest;
    for (uint32_t i = 0; i < LANES; i++) {
        const uint32_t dead = lanes->alive[i] - 1u, key = lanes->keys[i];
        const uint32_t low = key | dead, high = key & ~dead;
        least = low < least ? low : least;
        greatest = high > greatest ? high : greatest;
    }
    *span = (struct kiln_sort_span){least, greatest};
}

__attribute__((flatten)) static size_t list(const struct kiln_sort_slots *slots,
                                            const struct kiln_sort_cells *cells,
                                            kiln_sort_pair *pairs, uint32_t *counts,
                                            struct kiln_sort_span *span)
{
    const struct kiln_sort_cells layout = *cells;
    kiln_sort_pair *to = pairs;
    struct lanes lanes;
    for (uint32_t first = slots->first; first < slots->end; first += LANES) {
        const uint32_t remaining = slots->end - first,
                       count = remaining < LANES ? remaining : LANES;
        const struct kiln_particle *records = slots->records + first;
        struct kiln_particle tail[LANES];
        for (uint32_t i = AHEAD; i < AHEAD + LANES && i < remaining; i += RECORD_LINE)
            __builtin_prefetch(records + i);
        if (count < LANES) {
            memset(tail, 0, sizeof tail);
            memcpy(tail, records, count * sizeof *tail);
            records = tail;
        }
        find_keys(records, slots->eye, slots->forward, &layout, &lanes);
        widen(span, &lanes);
        const uint32_t entry = KILN_ENTRY(slots->system, first);
        for (uint32_t i = 0; i < count; i++) {
            *to = (kiln_sort_pair)lanes.keys[i] << 32 | (entry + i);
            to += lanes.alive[i];
            counts[lanes.cells[i]]++;
        }
    }
    return (size_t)(to - pairs);
}

__attribute__((flatten)) static void scatter(const kiln_sort_pair *pairs, size_t count,
                                             const struct kiln_sort_cells *cells, uint32_t *places,
                                             kiln_sort_pair *to)
{
    const struct kiln_sort_cells layout = *cells;
    uint32_t cell[LANES];
    for (; count >= LANES; count -= LANES, pairs += LANES) {
        for (uint32_t i = 0; i < LANES; i++)
            cell[i] = cell_of(&layout, (uint32_t)(pairs[i] >> 32));
        for (uint32_t i = 0; i < LANES; i++)
            to[places[cell[i]]++] = pairs[i];
    }
    for (size_t i = 0; i < count; i++)
        to[places[cell_of(&layout, (uint32_t)(pairs[i] >> 32))]++] = pairs[i];
}

const struct kiln_sort_loops KILN_SIMD_NAME(kiln_sort_loops) = {.list = list, .scatter = scatter};
