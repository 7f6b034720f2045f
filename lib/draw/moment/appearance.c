/* This file computes the appearance of living particles on the host from their records, looks and
 * random numbers, as the vertex shader does. */
#include "draw/moment/appearance.h"

#include <assert.h>

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
                            float progress)
{
    float x = progress * (float)(KILN_LOOK_SAMPLES - 1);
    uint32_t i = exact_uint(x);
    if (i > KILN_LOOK_SAMPLES - 2)
        i = KILN_LOOK_SAMPLES - 2;
    const float4 *samples = system->rows + (size_t)row * KILN_LOOK_SAMPLES;
    return mix4(samples[i], samples[i + 1], x - (float)i);
}

struct kiln_appearance_system kiln_appearance_system(const struct kiln_moment *moment,
                                                     uint32_t index)
{
    const struct kiln_pool_system *slots = &moment->pool->systems[index];
    return (struct kiln_appearance_system){
        .derived = kiln_scene_derived(moment->scene, index),
        .keys = moment->scene->keys,
        .records = moment->records + slots->base,
        .rows = moment->look_table + (size_t)index * KILN_LOOK_ROWS * KILN_LOOK_SAMPLES,
        .used = kiln_pool_used(slots),
        .step = moment->view.clock_step.x,
        .back = moment->view.within.x,
        .dt_s = moment->scene->dt_s,
        .spins = moment->spins && slots->spins ? moment->spins + slots->first_spin : NULL,
    };
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
    float4 shape = kiln_appearance_look(system, KILN_LOOK_SHAPE, progress);
    float4 spread = kiln_appearance_look(system, KILN_LOOK_SPREAD, progress);
    float scale = random_unit(particle_stream(system->derived, record), RANDOM_SCALE);
    *particle = (struct kiln_appearance){
        .position = particle_position(record),
        .radius = 0.5f * shape.x * (spread.x + (spread.y - spread.x) * scale),
        .progress = progress,
        .opacity = shape.z,
    };
    return true;
}

/* Returns the angle of a particle from its own rotation and spin, without collisions, rad. */
static float spin_angle(const struct kiln_appearance_system *system, struct kiln_particle record,
                        uint32_t stream, float progress)
{
    return instance_angle(stream, kiln_appearance_look(system, KILN_LOOK_TURN, progress),
                          kiln_appearance_look(system, KILN_LOOK_SPREAD, progress),
                          particle_age_before(record, system->step, system->back, system->dt_s));
}

float4 kiln_appearance_pose(const struct kiln_appearance_system *system, uint32_t slot,
                            float progress)
{
    if (system->spins)
        return spin_unit(spin_pose(system->spins[slot].pose));
    const struct kiln_particle record = system->records[slot];
    const uint32_t stream = particle_stream(system->derived, record);
    return instance_pose(stream, spin_angle(system, record, stream, progress));
}

struct instance_axes kiln_appearance_axes(const struct kiln_appearance_system *system,
                                          uint32_t slot, float progress, uint32_t orient)
{
    if (system->spins && orient == ORIENT_SPIN)
        return instance_posed(kiln_appearance_pose(system, slot, progress));
    const struct kiln_particle record = system->records[slot];
    const uint32_t stream = particle_stream(system->derived, record);
    const float angle = spin_angle(system, record, stream, progress);
    return instance_axes_of(orient, particle_velocity(record), angle, stream);
}

float3 kiln_appearance_glow(const struct kiln_appearance_system *system, float progress)
{
    float4 hot = kiln_appearance_look(system, KILN_LOOK_HOT, progress);
    float4 cool = kiln_appearance_look(system, KILN_LOOK_COOL, progress);
    return (float3){0.5f * (hot.x + cool.x), 0.5f * (hot.y + cool.y), 0.5f * (hot.z + cool.z)};
}
