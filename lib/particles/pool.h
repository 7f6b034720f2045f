/* A kiln_pool holds the particles of every system of a run in one buffer of records, where each
 * system owns a range of slots. It also counts the births on the host.
 *
 * Serial s of a system lives in slot base + s mod capacity. Capacity is at least the most births in
 * any window as long as the longest life, so that a slot is free when a birth needs it. Therefore
 * no atomic counter decides an order. (The thesis finds free slots with an atomic counter: Heinz
 * 2019, 3.3.4.) */
#ifndef KILN_PARTICLES_POOL_H
#define KILN_PARTICLES_POOL_H

#include "gpu/buffer.h"
#include "particles/canvas.h"
#include "particles/gas.h"
#include "shared/limits.h"
#include "shared/particle.h"

struct kiln_pool_system {
    uint32_t base, capacity; /* slots of this system in the record buffer */
    uint64_t next_serial;    /* the number of births so far */
    /* the part of a birth that carries over to the next step; see `wait` in births.h */
    uint64_t birth_wait;
    bool spins;          /* true: the system's particles have a spin */
    uint32_t first_spin; /* slots of this system in the buffer of spins */
    bool travels;        /* true: they have a way, the metres that they have travelled */
    uint32_t first_way;  /* slots of this system's ways in the same buffer */
};

struct kiln_pool {
    struct kiln_pool_system systems[KILN_MAX_SYSTEMS];
    uint32_t system_count;
    uint32_t slot_count;        /* slots of all systems */
    struct kiln_buffer records; /* struct kiln_particle [slot_count] */

    /* Spins and ways of particles: a struct kiln_spin for each slot of the systems that spin, and
     * one for each slot of those that travel. Its size is 0 if there are none. */
    struct kiln_buffer spins;

    /* Painted textures, in the order of the scene's meshes that take paint. */
    struct kiln_canvas canvases[KILN_MAX_MESHES];
    uint32_t canvas_count;

    struct kiln_gas gas[KILN_MAX_GAS]; /* domains of gas, in the order of the scene */
    uint32_t gas_count;
};

/* Describes what a pool holds; kiln_scene_pool_layout makes it from a scene. */
struct kiln_pool_layout {
    uint32_t system_count;
    uint32_t capacities[KILN_MAX_SYSTEMS]; /* slots of each system */
    bool spins[KILN_MAX_SYSTEMS];          /* whether each system's particles have a spin */
    bool travels[KILN_MAX_SYSTEMS];        /* whether they have a way */
    uint32_t canvas_count;
    struct kiln_canvas_shape canvases[KILN_MAX_MESHES];
    uint32_t gas_count;
    struct kiln_gas_shape gas[KILN_MAX_GAS];
};

/* Initialises a pool without particles, paint and gas. If device is NULL, records and spins are on
 * the host only. Fails if memory for paint is short; kiln_pool_finish frees the pool, also after a
 * failure. */
bool kiln_pool_init(struct kiln_pool *pool, struct kiln_device *device,
                    const struct kiln_pool_layout *layout, struct kiln_error *error);

/* Adds the memory of a pool on the host. */
void kiln_pool_footprint(const struct kiln_pool_layout *layout, struct kiln_footprint *footprint);
void kiln_pool_finish(struct kiln_pool *pool);

/* Copies particles, spins, paint and gas to another pool of the same layout, in host memory. */
bool kiln_pool_copy(struct kiln_pool *to, struct kiln_pool *from, struct kiln_error *error);

/* Copies records and spins to a pool of the same device, capacities and spins. Paint and counts of
 * births are not copied, so no step can follow. */
bool kiln_pool_copy_particles(struct kiln_pool *to, struct kiln_pool *from,
                              struct kiln_error *error);

/* Returns how many of a system's slots ever had a birth. These are the first slots; all others are
 * still zero. */
uint32_t kiln_pool_used(const struct kiln_pool_system *system);

#endif
