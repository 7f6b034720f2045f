/* Makes pools for tests that place particles by hand, or run a scene. */
#ifndef KILN_TESTS_POOLS_H
#define KILN_TESTS_POOLS_H

#include "particles/pool.h"
#include "scene/scene.h"

/* Initialises a pool with capacities[i] slots for system i, without spins and paint. device may be
 * NULL. */
void pool_init(struct kiln_pool *pool, struct kiln_device *device, const uint32_t *capacities,
               uint32_t system_count);

/* Initialises a pool with the same number of slots for each system of a scene. */
void pool_init_even(struct kiln_pool *pool, struct kiln_device *device,
                    const struct kiln_scene *scene, uint32_t capacity);

/* Initialises the pool of a run of a scene. */
void pool_init_of(struct kiln_pool *pool, struct kiln_device *device,
                  const struct kiln_scene *scene);

/* Gives spins to system 0 of a pool that has none, and returns them as zeros on the host. */
struct kiln_spin *pool_give_spins(struct kiln_pool *pool);

#endif
