/* Records, looks and random numbers put together as the vertex shader does it. */
#include "draw/living.h"

#include "shared/derived.h"
#include "shared/look_layout.h"

static float4 mix4(float4 a, float4 b, float t)
{
    return (float4){a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t,
                    a.w + (b.w - a.w) * t};
}

float4 kiln_living_look(const struct kiln_living_system *system, uint32_t row, float progress)
{
    float x = progress * (float)(KILN_LOOK_SAMPLES - 1);
    uint32_t i = (uint32_t)x;
    if (i > KILN_LOOK_SAMPLES - 2)
        i = KILN_LOOK_SAMPLES - 2;
    const float4 *samples = system->rows + (size_t)row * KILN_LOOK_SAMPLES;
    return mix4(samples[i], samples[i + 1], x - (float)i);
}

struct kiln_living_system kiln_living_system(const struct kiln_living_moment *moment,
                                             uint32_t index)
{
    const struct kiln_pool_system *slots = &moment->pool->systems[index];
    return (struct kiln_living_system){
        .derived = kiln_scene_derived(moment->scene, index),
        .keys = moment->scene->keys,
        .records = moment->records + slots->base,
        .rows = moment->table + (size_t)index * KILN_LOOK_ROWS * KILN_LOOK_SAMPLES,
        .used = kiln_pool_used(slots),
        .step = moment->view->clock_step.x,
        .dt_s = moment->scene->dt_s,
    };
}

bool kiln_living_at(const struct kiln_living_system *system, uint32_t slot,
                    struct kiln_living *particle)
{
    const struct kiln_particle record = system->records[slot];
    if (!particle_is_alive(record))
        return false;
    float age_s = particle_age(record, system->step, system->dt_s);
    float progress =
        particle_progress(age_s, particle_life_s(system->keys, system->derived, record));
    float4 shape = kiln_living_look(system, KILN_LOOK_SHAPE, progress);
    float4 spread = kiln_living_look(system, KILN_LOOK_SPREAD, progress);
    float scale = random_unit(particle_stream(system->derived, record), RANDOM_SCALE);
    *particle = (struct kiln_living){
        .position = particle_position(record),
        .radius = 0.5f * shape.x * (spread.x + (spread.y - spread.x) * scale),
        .progress = progress,
        .opacity = shape.z,
    };
    return true;
}

float3 kiln_living_glow(const struct kiln_living_system *system, float progress)
{
    float4 hot = kiln_living_look(system, KILN_LOOK_HOT, progress);
    float4 cool = kiln_living_look(system, KILN_LOOK_COOL, progress);
    return (float3){0.5f * (hot.x + cool.x), 0.5f * (hot.y + cool.y), 0.5f * (hot.z + cool.z)};
}
