/* Records, looks and random numbers put together as the vertex shader does it. */
#include "draw/living.h"

#include "shared/derived.h"
#include "shared/look_layout.h"

static float4 mix4(float4 a, float4 b, float t)
{
    return (float4){a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t,
                    a.w + (b.w - a.w) * t};
}

/* A row of a system's part of the table. */
static float4 look_at(const float4 *rows, uint32_t row, float progress)
{
    float x = progress * (float)(KILN_LOOK_SAMPLES - 1);
    uint32_t i = (uint32_t)x;
    if (i > KILN_LOOK_SAMPLES - 2)
        i = KILN_LOOK_SAMPLES - 2;
    const float4 *samples = rows + (size_t)row * KILN_LOOK_SAMPLES;
    return mix4(samples[i], samples[i + 1], x - (float)i);
}

void kiln_living_visit(const struct kiln_scene *scene, const struct kiln_pool *pool,
                       const struct kiln_particle *records, const struct kiln_view *view,
                       const float4 *table, uint32_t system,
                       void (*visit)(void *context, const struct kiln_living *particle),
                       void *context)
{
    const struct kiln_derived_params derived = kiln_scene_derived(scene, system);
    const struct kiln_pool_system *slots = &pool->systems[system];
    const float4 *rows = table + (size_t)system * KILN_LOOK_ROWS * KILN_LOOK_SAMPLES;
    uint32_t used = kiln_pool_used(slots);
    for (uint32_t i = 0; i < used; i++) {
        struct kiln_particle record = records[slots->base + i];
        if (!particle_is_alive(record))
            continue;
        float age_s = particle_age(record, view->clock_step.x, scene->dt_s);
        float progress = particle_progress(age_s, particle_life_s(scene->keys, derived, record));
        float4 shape = look_at(rows, KILN_LOOK_SHAPE, progress);
        float4 spread = look_at(rows, KILN_LOOK_SPREAD, progress);
        float4 hot = look_at(rows, KILN_LOOK_HOT, progress);
        float4 cool = look_at(rows, KILN_LOOK_COOL, progress);
        float scale = random_unit(particle_stream(derived, record), RANDOM_SCALE);
        const struct kiln_living particle = {
            .position = particle_position(record),
            .radius = 0.5f * shape.x * (spread.x + (spread.y - spread.x) * scale),
            .progress = progress,
            .opacity = shape.z,
            .glow = {0.5f * (hot.x + cool.x), 0.5f * (hot.y + cool.y), 0.5f * (hot.z + cool.z)},
        };
        visit(context, &particle);
    }
}
