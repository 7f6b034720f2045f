/* Makes pools of particles for tests that place particles by hand, or run a scene. A pool that
 * cannot be made fails the test. */
#include "support/pools.h"

#include <string.h>

#include "scene/pool_layout.h"
#include "support/cmocka.h"

static void init(struct kiln_pool *pool, struct kiln_device *device,
                 const struct kiln_pool_layout *layout)
{
    struct kiln_error error = {0};
    if (!kiln_pool_init(pool, device, layout, &error))
        fail_msg("%s", error.message);
}

void pool_init(struct kiln_pool *pool, struct kiln_device *device, const uint32_t *capacities,
               uint32_t system_count)
{
    struct kiln_pool_layout layout = {.system_count = system_count};
    memcpy(layout.capacities, capacities, system_count * sizeof *capacities);
    init(pool, device, &layout);
}

void pool_init_even(struct kiln_pool *pool, struct kiln_device *device,
                    const struct kiln_scene *scene, uint32_t capacity)
{
    struct kiln_pool_layout layout = {.system_count = scene->system_count};
    for (uint32_t i = 0; i < scene->system_count; i++)
        layout.capacities[i] = capacity;
    init(pool, device, &layout);
}

void pool_init_of(struct kiln_pool *pool, struct kiln_device *device,
                  const struct kiln_scene *scene)
{
    const struct kiln_pool_layout layout = kiln_scene_pool_layout(scene);
    init(pool, device, &layout);
}

struct kiln_spin *pool_give_spins(struct kiln_pool *pool)
{
    struct kiln_error error = {0};
    const size_t size = pool->systems[0].capacity * sizeof(struct kiln_spin);
    pool->systems[0].spins = true;
    kiln_buffer_init(&pool->spins, pool->records.device, size, "spins");
    struct kiln_spin *spins = kiln_buffer_host(&pool->spins, KILN_OVERWRITE, &error);
    if (!spins)
        fail_msg("%s", error.message);
    memset(spins, 0, size);
    return spins;
}
