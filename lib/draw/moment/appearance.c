/* This file computes the appearance of living particles on the host from their records, looks and
 * random numbers, as the vertex shader does. */
#include "draw/moment/appearance.h"

#include <assert.h>

#include "scene/family.h"
#include "shared/derived.h"
#include "shared/exact.h"
#include "shared/look_layout.h"

static_assert(ORIENT_VELOCITY == KILN_ORIENT_VELOCITY && ORIENT_SPIN == KILN_ORIENT_SPIN,
              "ways to lie in the world");

static float4 mix4(float4 a, float4 b, float t)
{
    return (float4){a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t,
                    a.w + (b.w - a.w) * t};
}

float4 kiln_appearance_look(const struct kiln_appearance_system *system, uint32_t row,
                            const struct value_clocks *clocks)
{
    float x = clocks->life * (float)(KILN_LOOK_SAMPLES - 1);
    uint32_t i = exact_uint(x);
    if (i > KILN_LOOK_SAMPLES - 2)
        i = KILN_LOOK_SAMPLES - 2;
    const float4 *samples = system->rows + (size_t)row * KILN_LOOK_SAMPLES;
    const float4 look = mix4(samples[i], samples[i + 1], x - (float)i);
    if (system->program->count == 0)
        return look;
    return kiln_look_multiply(system->table, system->program, row, clocks, look);
}

struct kiln_appearance_system kiln_appearance_system(const struct kiln_moment *moment,
                                                     uint32_t index)
{
    const struct kiln_pool_system *slots = &moment->pool->systems[index];
    const struct kiln_parent *parent = &moment->scene->systems[index].emit.parent;
    struct kiln_appearance_system system = {
        .derived = kiln_scene_derived(moment->scene, index),
        .keys = moment->scene->keys,
        .records = moment->records + slots->base,
        .table = moment->look_table,
        .program = &moment->look_programs[index],
        .eye = {moment->view.eye.x, moment->view.eye.y, moment->view.eye.z},
        .time_s = moment->view.clock.x,
        .rows = moment->look_table + (size_t)index * KILN_LOOK_ROWS * KILN_LOOK_SAMPLES,
        .used = kiln_pool_used(slots),
        .step = moment->view.clock_step.x,
        .back = moment->view.within.x,
        .dt_s = moment->scene->dt_s,
        .spins = moment->spins && slots->spins ? moment->spins + slots->first_spin : NULL,
    };
    if (kiln_family_inherits(&moment->scene->systems[index])) {
        system.of_parent = kiln_scene_derived(moment->scene, parent->system);
        system.parents = moment->records + moment->pool->systems[parent->system].base;
        system.slots_of_parent = parent->slots;
    }
    return system;
}

struct value_clocks kiln_appearance_clocks(const struct kiln_appearance_system *system,
                                           uint32_t slot, float age_s, float progress)
{
    const struct kiln_particle record = system->records[slot];
    const float3 position = particle_position(record);
    struct value_clocks clocks =
        value_clocks_at(system->time_s, system->derived.random_key, system->derived.scene_key);
    clocks.life = progress;
    clocks.age_s = age_s;
    clocks.height = position.y;
    clocks.distance = float3_length(float3_sub(position, system->eye));
    clocks.velocity = particle_velocity(record);
    clocks.stream = particle_stream(system->derived, record);
    if (system->parents)
        clocks = particle_clocks_of_child(system->keys, clocks, system->of_parent,
                                          system->parents[slot / system->slots_of_parent], record);
    return clocks;
}

bool kiln_appearance_at(const struct kiln_appearance_system *system, uint32_t slot,
                        struct kiln_appearance *particle)
{
    const struct kiln_particle record = system->records[slot];
    if (!particle_is_alive(record))
        return false;
    float age_s = particle_age_before(record, system->step, system->back, system->dt_s);
    float progress =
        particle_progress(age_s, particle_life_s(system->keys, system->derived, record));
    const struct value_clocks clocks = kiln_appearance_clocks(system, slot, age_s, progress);
    float4 shape = kiln_appearance_look(system, KILN_LOOK_SHAPE, &clocks);
    float4 spread = kiln_appearance_look(system, KILN_LOOK_SPREAD, &clocks);
    float scale = random_unit(clocks.stream, RANDOM_SCALE);
    *particle = (struct kiln_appearance){
        .position = particle_position(record),
        .radius = 0.5f * shape.x * (spread.x + (spread.y - spread.x) * scale),
        .progress = progress,
        .opacity = shape.z,
        .clocks = clocks,
    };
    return true;
}

/* Returns the angle of a particle from its own rotation and spin, without collisions, rad. */
static float spin_angle(const struct kiln_appearance_system *system, uint32_t slot,
                        const struct value_clocks *clocks)
{
    const float turned_s = particle_turned_s(system->records[slot], clocks->age_s, system->dt_s);
    return instance_angle(clocks->stream, kiln_appearance_look(system, KILN_LOOK_TURN, clocks),
                          kiln_appearance_look(system, KILN_LOOK_SPREAD, clocks), turned_s);
}

float4 kiln_appearance_pose(const struct kiln_appearance_system *system, uint32_t slot,
                            const struct value_clocks *clocks)
{
    if (system->spins)
        return spin_unit(spin_pose(system->spins[slot].pose));
    return instance_pose(clocks->stream, spin_angle(system, slot, clocks));
}

struct instance_axes kiln_appearance_axes(const struct kiln_appearance_system *system,
                                          uint32_t slot, const struct value_clocks *clocks,
                                          uint32_t orient)
{
    if (system->spins && orient == ORIENT_SPIN)
        return instance_posed(kiln_appearance_pose(system, slot, clocks));
    return instance_axes_of(orient, particle_heading(system->records[slot]),
                            spin_angle(system, slot, clocks), clocks->stream);
}

float3 kiln_appearance_glow(const struct kiln_appearance_system *system,
                            const struct value_clocks *clocks)
{
    float4 hot = kiln_appearance_look(system, KILN_LOOK_HOT, clocks);
    float4 cool = kiln_appearance_look(system, KILN_LOOK_COOL, clocks);
    return (float3){0.5f * (hot.x + cool.x), 0.5f * (hot.y + cool.y), 0.5f * (hot.z + cool.z)};
}
