/* Makes pools, the buffers with the records of all particles of a scene, for tests that place
 * particles by hand or run a scene. An error fails the test. */
#ifndef KILN_TESTS_POOLS_H
#define KILN_TESTS_POOLS_H

#include "particles/pool.h"
#include "scene/scene.h"

/* Initialises a pool with capacities[i] slots for system i, without the optional buffers for spin
 * and paint. device: NULL for a pool on the host only. */
void pool_init(struct kiln_pool *pool, struct kiln_device *device, const uint32_t *capacities,
               uint32_t system_count);

/* Initialises a pool with `capacity` slots for each system of a scene. */
void pool_init_even(struct kiln_pool *pool, struct kiln_device *device,
                    const struct kiln_scene *scene, uint32_t capacity);

/* Initialises a pool with all slots and buffers that a run of a scene needs. */
void pool_init_of(struct kiln_pool *pool, struct kiln_device *device,
                  const struct kiln_scene *scene);

/* Gives system 0 a spin for each slot in a pool that has no spins. Returns the spins on the host,
 * all zero. */
struct kiln_spin *pool_give_spins(struct kiln_pool *pool);

#endif
