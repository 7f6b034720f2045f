/* This file computes living particles a block of slots at a time. Every loop runs over lanes and
 * has no branches, so that compilers vectorise it. */
#include <math.h>

#include "draw/moment/appearance_blocks.h"
#include "shared/exact.h"

static inline float look_at(const float *samples, struct kiln_look_place at)
{
    float a = samples[at.texel], b = samples[at.texel + 4];
    return a + (b - a) * at.part;
}

static inline void load(struct kiln_appearance_block *b,
                        const struct kiln_appearance_system *system, uint32_t first)
{
    const uint32_t left = system->used - first;
    if (left >= KILN_LANES) {
        kiln_lanes_load(&b->lanes, system->records + first);
        return;
    }
    struct kiln_particle rest[KILN_LANES] = {0};
    memcpy(rest, system->records + first, left * sizeof *rest);
    kiln_lanes_load(&b->lanes, rest);
}

/* Finds radius and opacity of lane i of a system whose look has values over other clocks than
 * life. */
static inline void find_own(const struct kiln_appearance_system *system, uint32_t first,
                            struct kiln_appearance_block *b, uint32_t i)
{
    struct kiln_appearance particle;
    if (!b->alive[i] || !kiln_appearance_at(system, first + i, &particle))
        return;
    b->radius[i] = particle.radius;
    b->opacity[i] = particle.opacity;
}

__attribute__((flatten)) void
KILN_SIMD_NAME(kiln_appearance_find)(const struct kiln_appearance_system *system, uint32_t first,
                                     struct kiln_appearance_block *b)
{
    load(b, system, first);
    kiln_lanes_find_ages(&b->lanes, system->keys, system->derived, system->step, system->back);
    const float *shape = &system->rows[(size_t)KILN_LOOK_SHAPE * KILN_LOOK_SAMPLES].x;
    const float *spread = &system->rows[(size_t)KILN_LOOK_SPREAD * KILN_LOOK_SAMPLES].x;
    const struct kiln_derived_params derived = system->derived;
    const bool own = system->program->count > 0;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        struct kiln_particle p = kiln_lanes_record(&b->lanes, i);
        float progress = particle_progress(b->lanes.age_s[i], b->lanes.life_s[i]);
        struct kiln_look_place at = kiln_look_place_at(progress);
        float scale = random_unit(particle_stream(derived, p), RANDOM_SCALE);
        float least = look_at(spread, at), most = look_at(spread + 1, at);
        float radius = 0.5f * look_at(shape, at) * (least + (most - least) * scale);
        float opacity = look_at(shape + 2, at);
        bool alive = particle_is_alive(p);
        kiln_set3(&b->position, i, particle_position(p));
        b->alive[i] = alive;
        b->progress[i] = progress;
        b->radius[i] = alive ? radius : 0.0f;
        b->opacity[i] = alive ? opacity : 0.0f;
    }
    for (uint32_t i = 0; i < KILN_LANES && own; i++)
        find_own(system, first, b, i);
}
