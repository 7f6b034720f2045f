/* This file shows particles of bursts at the moment of their birth. Their records are computed on
 * the host for every technique, by the function that the next step gives birth to them with
 * (shaders/shared/step.h). So they are at the place where that step begins, at age 0, and no state
 * changes: the next step finds the pool as it would without them. */
#include "sim/step/newborn.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "scene/scene_births.h"
#include "shared/step.h"

/* A slot that a shown particle took, and what was in it. */
struct kiln_newborn_slot {
    uint32_t slot, spin; /* in the whole pool; spin is only used if `spins` */
    bool spins;
    struct kiln_particle particle;
    struct kiln_spin turning;
};

/* Counts the births of a system's next step, without any effect on the pool. */
static struct kiln_births births_after(const struct kiln_scene *scene, uint32_t index,
                                       const struct kiln_pool *pool, uint32_t step)
{
    struct kiln_births births = {.count = 0};
    const struct kiln_system *system = &scene->systems[index];
    if (!system->enabled || system->emit.parent.enabled || system->emit.burst_count == 0)
        return births;
    struct kiln_scene_births counted;
    uint64_t wait = pool->systems[index].birth_wait;
    kiln_scene_births_init(&counted, scene, index);
    kiln_births_step(&counted.source, step + 1, &wait, &births);
    return births;
}

/* Returns how many of the births happen in bursts at the start of the step. */
static uint32_t count_newborn(const struct kiln_births *births)
{
    uint32_t count = 0;
    for (uint32_t g = births->steady_groups; g < births->group_count; g++)
        count += births->groups[g].first == 0 ? births->groups[g].count : 0;
    return count;
}

/* The places of the pool on the host. */
struct places {
    struct kiln_pool *pool;
    struct kiln_particle *records;
    struct kiln_spin *spins; /* NULL: no system spins */
};

static struct kiln_spin spin_of(const struct kiln_sim *sim, struct kiln_particle particle)
{
    const uint32_t stream = particle_stream(sim->step->derived, particle);
    const float4 axis = sim->step->spin_axis;
    const float3 rate = spin_at_birth(stream, sim->step->spin_low, sim->step->spin_high,
                                      (float3){axis.x, axis.y, axis.z});
    return (struct kiln_spin){spin_words_of(rate), spin_pose_words(spin_any_pose(stream))};
}

/* Puts birth number `index` of a system into its slot, unless the step would remove it there. */
static void show_birth(struct kiln_newborn *newborn, const struct kiln_sim *sim,
                       const struct places *places, uint32_t system, uint32_t index)
{
    const struct kiln_pool_system *owner = &places->pool->systems[system];
    const struct kiln_particle particle = step_birth(sim, index);
    const float3 place = particle_position(particle);
    if (!step_is_sane(place) || step_is_removed(sim, place))
        return;
    const uint32_t slot = particle.position_serial.w % owner->capacity;
    struct kiln_newborn_slot *old = &newborn->slots[newborn->count++];
    *old = (struct kiln_newborn_slot){.slot = owner->base + slot,
                                      .spin = owner->first_spin + slot,
                                      .spins = places->spins && owner->spins};
    old->particle = places->records[old->slot];
    places->records[old->slot] = particle;
    if (old->spins) {
        old->turning = places->spins[old->spin];
        places->spins[old->spin] = spin_of(sim, particle);
    }
}

static bool find_places(struct places *places, struct kiln_pool *pool, struct kiln_error *error)
{
    *places = (struct places){.pool = pool};
    places->records = kiln_buffer_host(&pool->records, KILN_READ_WRITE, error);
    if (places->records && pool->spins.size > 0)
        places->spins = kiln_buffer_host(&pool->spins, KILN_READ_WRITE, error);
    return places->records && (places->spins || pool->spins.size == 0);
}

bool kiln_newborn_show(struct kiln_newborn *newborn, struct kiln_sim_params *params,
                       const struct kiln_scene *scene, struct kiln_pool *pool, uint32_t step,
                       struct kiln_error *error)
{
    struct kiln_births births[KILN_MAX_SYSTEMS];
    uint32_t total = 0;
    if (newborn->shown) /* drawing was given up, and is tried again */
        return true;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        births[i] = births_after(scene, i, pool, step);
        total += count_newborn(&births[i]);
    }
    if (total == 0)
        return true;
    newborn->slots = calloc(total, sizeof *newborn->slots);
    if (!newborn->slots)
        return kiln_error_no_memory(error, "the simulation");
    memcpy(newborn->systems, pool->systems, sizeof newborn->systems);
    newborn->shown = true;
    struct places places;
    if (!kiln_sim_params_births(params, scene, pool, step + 1, error) ||
        !find_places(&places, pool, error))
        return false;
    const float4 *words = NULL;
    if (params->grids->has_sources) {
        words = kiln_buffer_host(&params->grids->words, KILN_READ, error);
        if (!words)
            return false;
    }
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_sim sim = {.step = &params->systems[i],
                                     .surroundings = &params->surroundings,
                                     .value_keys = scene->keys,
                                     .grid_words = words};
        uint32_t index = births[i].steady;
        for (uint32_t g = births[i].steady_groups; g < births[i].group_count; g++) {
            const struct kiln_birth_group *group = &births[i].groups[g];
            for (uint32_t k = 0; k < group->count && group->first == 0; k++)
                show_birth(newborn, &sim, &places, i, index + k);
            index += group->count;
        }
    }
    return true;
}

bool kiln_newborn_hide(struct kiln_newborn *newborn, struct kiln_pool *pool,
                       struct kiln_error *error)
{
    struct places places;
    if (!newborn->shown)
        return true;
    if (!find_places(&places, pool, error))
        return false;
    for (uint32_t i = 0; i < newborn->count; i++) {
        const struct kiln_newborn_slot *old = &newborn->slots[i];
        places.records[old->slot] = old->particle;
        if (old->spins)
            places.spins[old->spin] = old->turning;
    }
    memcpy(pool->systems, newborn->systems, sizeof newborn->systems);
    kiln_newborn_finish(newborn);
    return true;
}

void kiln_newborn_finish(struct kiln_newborn *newborn)
{
    free(newborn->slots);
    *newborn = (struct kiln_newborn){.shown = false};
}
