/* The slots of every system. */
#include "particles/pool.h"

#include <assert.h>
#include <string.h>

static_assert(sizeof(struct kiln_particle) == 32, "std430");

void kiln_pool_init(struct kiln_pool *pool, struct kiln_device *device, const uint32_t *capacities,
                    uint32_t system_count)
{
    *pool = (struct kiln_pool){.system_count = system_count};
    for (uint32_t i = 0; i < system_count; i++) {
        pool->systems[i] =
            (struct kiln_pool_system){.base = pool->slot_count, .capacity = capacities[i]};
        pool->slot_count += capacities[i];
    }
    kiln_buffer_init(&pool->records, device,
                     (size_t)pool->slot_count * sizeof(struct kiln_particle), "particles");
}

void kiln_pool_finish(struct kiln_pool *pool)
{
    kiln_buffer_finish(&pool->records);
    for (uint32_t i = 0; i < pool->canvas_count; i++)
        kiln_canvas_finish(&pool->canvases[i]);
    *pool = (struct kiln_pool){.system_count = 0};
}

bool kiln_pool_copy(struct kiln_pool *to, struct kiln_pool *from, struct kiln_error *error)
{
    assert(to->slot_count == from->slot_count && to->system_count == from->system_count);
    const void *source = kiln_buffer_host(&from->records, KILN_READ, error);
    void *target = source ? kiln_buffer_host(&to->records, KILN_OVERWRITE, error) : NULL;
    if (!target)
        return false;
    memcpy(target, source, from->records.size);
    memcpy(to->systems, from->systems, sizeof to->systems);
    for (uint32_t i = 0; i < from->canvas_count; i++) {
        if (!kiln_canvas_copy(&to->canvases[i], &from->canvases[i], error))
            return false;
        to->canvas_count = i < to->canvas_count ? to->canvas_count : i + 1;
    }
    while (to->canvas_count > from->canvas_count)
        kiln_canvas_finish(&to->canvases[--to->canvas_count]);
    return true;
}

uint32_t kiln_pool_used(const struct kiln_pool_system *system)
{
    return system->next_serial < system->capacity ? (uint32_t)system->next_serial
                                                  : system->capacity;
}
