/* This file creates, copies and frees the pool, which is the state of a simulation: the records of
 * all particles, the slots that each system owns, spins, and painted textures (canvases).
 *
 * The frame loop (lib/frame/loop.c) creates a pool at its set-up, and copies a pool when it
 * continues from the state of another loop. The first step or a saved state adds spins, for systems
 * that spin; lib/sim/paint and lib/job/state.c add the canvases. Shaders read records and spins in
 * the std430 layout, so both structs must keep their size. kiln_pool_copy must copy everything that
 * later steps depend on. */
#include "particles/pool.h"

#include <assert.h>
#include <string.h>

static_assert(sizeof(struct kiln_particle) == 32, "std430");
static_assert(sizeof(struct kiln_spin) == 32, "std430");

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

void kiln_pool_add_spins(struct kiln_pool *pool, const bool *systems)
{
    uint32_t slots = 0;
    for (uint32_t i = 0; i < pool->system_count && pool->spins.size == 0; i++) {
        pool->systems[i].spins = systems[i];
        pool->systems[i].first_spin = slots;
        slots += systems[i] ? pool->systems[i].capacity : 0;
    }
    if (slots > 0)
        kiln_buffer_init(&pool->spins, pool->records.device, slots * sizeof(struct kiln_spin),
                         "spins");
}

void kiln_pool_finish(struct kiln_pool *pool)
{
    kiln_buffer_finish(&pool->records);
    kiln_buffer_finish(&pool->spins);
    for (uint32_t i = 0; i < pool->canvas_count; i++)
        kiln_canvas_finish(&pool->canvases[i]);
    *pool = (struct kiln_pool){.system_count = 0};
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

/* Makes as many spins as the other pool has. */
static void resize_spins(struct kiln_pool *pool, const struct kiln_pool *other)
{
    if (pool->spins.size == other->spins.size)
        return;
    kiln_buffer_finish(&pool->spins);
    kiln_buffer_init(&pool->spins, pool->records.device, other->spins.size, "spins");
}

bool kiln_pool_copy_particles(struct kiln_pool *to, struct kiln_pool *from,
                              struct kiln_error *error)
{
    assert(to->slot_count == from->slot_count && to->system_count == from->system_count);
    resize_spins(to, from);
    return kiln_buffer_copy(&to->records, &from->records, error) &&
           (from->spins.size == 0 || kiln_buffer_copy(&to->spins, &from->spins, error));
}

bool kiln_pool_copy(struct kiln_pool *to, struct kiln_pool *from, struct kiln_error *error)
{
    assert(to->slot_count == from->slot_count && to->system_count == from->system_count);
    memcpy(to->systems, from->systems, sizeof to->systems);
    resize_spins(to, from);
    if (!copy_buffer(&to->records, &from->records, error) ||
        !copy_buffer(&to->spins, &from->spins, error))
        return false;
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
