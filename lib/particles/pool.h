/* The particles of every system of a run: one buffer of records, each system owning a range of
 * slots, and the host's count of births.
 *
 * Serial s of a system lives in slot base + s mod capacity; capacity is at least the most births in
 * any window as long as the longest life, so a slot is free when its turn comes and no atomic
 * decides an order (the thesis finds free slots with an atomic counter: 3.3.4).
 */
#ifndef KILN_PARTICLES_POOL_H
#define KILN_PARTICLES_POOL_H

#include "gpu/buffer.h"
#include "particles/canvas.h"
#include "shared/limits.h"
#include "shared/particle.h"

struct kiln_pool_system {
    uint32_t base, capacity; /* slots of this system in the record buffer */
    uint64_t next_serial;    /* births so far */
    uint64_t birth_wait;     /* what the next birth of the rate waits for; see births.h */
    bool spins;              /* its particles turn: */
    uint32_t first_spin;     /* slots of this system in the buffer of spins */
};

struct kiln_pool {
    struct kiln_pool_system systems[KILN_MAX_SYSTEMS];
    uint32_t system_count;
    uint32_t slot_count;        /* of all systems */
    struct kiln_buffer records; /* struct kiln_particle [slot_count] */

    /* How they turn: struct kiln_spin, one for each slot of the systems that spin. Of size 0 before
     * the first step, and where none does. */
    struct kiln_buffer spins;

    /* What they painted, in the order of the scene's meshes that take paint: none before the first
     * step. */
    struct kiln_canvas canvases[KILN_MAX_MESHES];
    uint32_t canvas_count;
};

/* capacities[i] slots for system i; device NULL keeps the records on the host. */
void kiln_pool_init(struct kiln_pool *pool, struct kiln_device *device, const uint32_t *capacities,
                    uint32_t system_count);
void kiln_pool_finish(struct kiln_pool *pool);

/* Makes room for how the particles of these systems turn, as zeros; nothing if it is there. */
void kiln_pool_add_spins(struct kiln_pool *pool, const bool *systems);

/* Gives a pool the particles of another one of the same capacities, by way of the host, how they
 * turn and what they painted. */
bool kiln_pool_copy(struct kiln_pool *to, struct kiln_pool *from, struct kiln_error *error);

/* Slots of a system that were ever born into: the first so many; the rest is still zero. */
uint32_t kiln_pool_used(const struct kiln_pool_system *system);

/* A draw entry names a particle of any system in 32 bits; slot: of the whole record buffer. */
#define KILN_ENTRY(system, slot) ((uint32_t)(system) << 24 | (slot))
#define KILN_ENTRY_SYSTEM(entry) ((entry) >> 24)
#define KILN_ENTRY_SLOT(entry)   ((entry)&0xffffffu)

#endif
