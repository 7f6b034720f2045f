/* This file creates, copies and frees the pool, which is the state of a simulation: the records of
 * all particles, the slots that each system owns, spins, painted textures (canvases), and gas.
 *
 * The frame loop (lib/frame/loop.c) creates a pool at its set-up, and copies a pool when it
 * continues from the state of another loop. Shaders read records and spins in the std430 layout, so
 * both structs must keep their size. kiln_pool_copy must copy everything that later steps depend
 * on. */
#include "particles/pool.h"

#include <assert.h>
#include <string.h>

#include "base/error.h"

static_assert(sizeof(struct kiln_particle) == 32, "std430");
static_assert(sizeof(struct kiln_spin) == 32, "std430");

bool kiln_pool_init(struct kiln_pool *pool, struct kiln_device *device,
                    const struct kiln_pool_layout *layout, struct kiln_error *error)
{
    *pool = (struct kiln_pool){.system_count = layout->system_count};
    uint32_t spins = 0;
    for (uint32_t i = 0; i < layout->system_count; i++) {
        const uint32_t capacity = layout->capacities[i];
        pool->systems[i] = (struct kiln_pool_system){.base = pool->slot_count,
                                                     .capacity = capacity,
                                                     .spins = layout->spins[i],
                                                     .first_spin = spins,
                                                     .travels = layout->travels[i]};
        pool->slot_count += capacity;
        spins += layout->spins[i] ? capacity : 0;
        pool->systems[i].first_way = spins;
        spins += layout->travels[i] ? capacity : 0;
    }
    kiln_buffer_init(&pool->records, device,
                     (size_t)pool->slot_count * sizeof(struct kiln_particle), "particles");
    if (spins > 0)
        kiln_buffer_init(&pool->spins, device, spins * sizeof(struct kiln_spin), "spins");
    for (uint32_t i = 0; i < layout->canvas_count; i++) {
        const struct kiln_canvas_shape *shape = &layout->canvases[i];
        pool->canvas_count = i + 1;
        if (!kiln_canvas_init(&pool->canvases[i], shape->edge, shape->slot_count, error))
            return false;
    }
    pool->gas_count = layout->gas_count;
    for (uint32_t i = 0; i < layout->gas_count; i++)
        kiln_gas_init(&pool->gas[i], &layout->gas[i]);
    return true;
}

void kiln_pool_finish(struct kiln_pool *pool)
{
    kiln_buffer_finish(&pool->records);
    kiln_buffer_finish(&pool->spins);
    for (uint32_t i = 0; i < pool->canvas_count; i++)
        kiln_canvas_finish(&pool->canvases[i]);
    for (uint32_t i = 0; i < pool->gas_count; i++)
        kiln_gas_finish(&pool->gas[i]);
    *pool = (struct kiln_pool){.system_count = 0};
}

void kiln_pool_footprint(const struct kiln_pool_layout *layout, struct kiln_footprint *footprint)
{
    for (uint32_t i = 0; i < layout->system_count; i++) {
        const size_t rows = (size_t)layout->spins[i] + layout->travels[i];
        const size_t spin = rows * sizeof(struct kiln_spin);
        kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, layout->capacities[i],
                           sizeof(struct kiln_particle) + spin);
    }
    for (uint32_t i = 0; i < layout->canvas_count; i++)
        kiln_canvas_footprint(&layout->canvases[i], footprint);
}

static bool copy_buffer(struct kiln_buffer *to, struct kiln_buffer *from, struct kiln_error *error)
{
    if (from->size == 0)
        return true;
    const void *source = kiln_buffer_host(from, KILN_READ, error);
    void *target = source ? kiln_buffer_host(to, KILN_OVERWRITE, error) : NULL;
    if (target)
        memcpy(target, source, from->size);
    return target != NULL;
}

bool kiln_pool_copy_particles(struct kiln_pool *to, struct kiln_pool *from,
                              struct kiln_error *error)
{
    assert(to->slot_count == from->slot_count && to->spins.size == from->spins.size);
    return kiln_buffer_copy(&to->records, &from->records, error) &&
           (from->spins.size == 0 || kiln_buffer_copy(&to->spins, &from->spins, error));
}

bool kiln_pool_copy(struct kiln_pool *to, struct kiln_pool *from, struct kiln_error *error)
{
    assert(to->slot_count == from->slot_count && to->spins.size == from->spins.size);
    assert(to->canvas_count == from->canvas_count);
    memcpy(to->systems, from->systems, sizeof to->systems);
    if (!copy_buffer(&to->records, &from->records, error) ||
        !copy_buffer(&to->spins, &from->spins, error))
        return false;
    for (uint32_t i = 0; i < from->canvas_count; i++)
        kiln_canvas_copy(&to->canvases[i], &from->canvases[i]);
    for (uint32_t i = 0; i < from->gas_count; i++) {
        if (!kiln_gas_fetch(&from->gas[i], error))
            return false;
        if (!kiln_gas_copy(&to->gas[i], &from->gas[i]))
            return kiln_error_no_memory(error, "a copy of gas");
    }
    return true;
}

uint32_t kiln_pool_used(const struct kiln_pool_system *system)
{
    return system->next_serial < system->capacity ? (uint32_t)system->next_serial
                                                  : system->capacity;
}
