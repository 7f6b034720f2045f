/* A kiln_smoke holds the particles that throw a shadow, gathered once a moment into a compact
 * array, and names the gas that does. */
#ifndef KILN_DRAW_LIGHT_SMOKE_H
#define KILN_DRAW_LIGHT_SMOKE_H

#include "base/thread.h"
#include "draw/moment/appearance.h"

struct kiln_error;
struct kiln_gas_cells;

/* Describes a ball of smoke. */
struct kiln_puff {
    float3 position;  /* m */
    float radius;     /* m, above 0 */
    float extinction; /* summed over its volume, m^2 */
};

/* Each chunk of puffs starts at a multiple of KILN_SMOKE_CHUNK, so that the index of a puff
 * follows from the pool alone, not from threads. */
enum { KILN_SMOKE_CHUNK = 2048 };

struct kiln_smoke {
    struct kiln_puff *puffs;
    uint32_t *counts; /* number of puffs in each chunk */
    uint32_t chunk_count;
    uint32_t capacity;                /* chunks that there is room for */
    const struct kiln_gas_cells *gas; /* the gas that throws shadows, too; NULL: there is none */
};

/* Gathers the puffs of all systems that throw a shadow. `smoke` starts as zeros and can be gathered
 * into again. Returns false with an error: no memory. */
bool kiln_smoke_gather(struct kiln_smoke *smoke, const struct kiln_moment *moment,
                       struct kiln_threads *threads, struct kiln_error *error);
void kiln_smoke_finish(struct kiln_smoke *smoke);

#endif
