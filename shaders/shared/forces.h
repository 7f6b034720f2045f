/* The forces of a system, added up and integrated. A new force is a file force_name.h with one
 * function, and a row here; a limit adds nothing up and has none. Forces that look up grids have
 * rows of their own, which shaders of scenes without grids are spared.
 */
#ifndef KILN_SHARED_FORCES_H
#define KILN_SHARED_FORCES_H

#include "shared/force_curl.h"
#include "shared/force_drag.h"
#include "shared/force_gravity.h"
#include "shared/force_limit.h"
#include "shared/force_wind.h"

#define FORCES(ROW)                                                                                \
    ROW(FORCE_GRAVITY, force_gravity)                                                              \
    ROW(FORCE_DRAG, force_drag)                                                                    \
    ROW(FORCE_WIND, force_wind)                                                                    \
    ROW(FORCE_CURL, force_curl)

#if defined(GL_core_profile) && !defined(GRIDS)
#define FORCES_OF_GRIDS(ROW)
#else
#include "shared/force_field.h"
#define FORCES_OF_GRIDS(ROW) ROW(FORCE_FIELD, force_field)
#endif

FN S(force_effect) forces_one(SIM_PARAM uint kind, S(force_input) force)
{
    EXACT S(force_effect) effect;
    effect.acceleration = FLOAT3(0.0f, 0.0f, 0.0f);
    effect.pull = 0.0f;
#define FORCES_ROW(id, function)                                                                   \
    if (kind == id)                                                                                \
        effect = function(force);
    FORCES(FORCES_ROW)
#undef FORCES_ROW
#define FORCES_ROW(id, function)                                                                   \
    if (kind == id)                                                                                \
        effect = function(SIM force);
    FORCES_OF_GRIDS(FORCES_ROW)
#undef FORCES_ROW
    return effect;
}

FN S(force_effect) forces_add(S(force_effect) sum, S(force_effect) effect)
{
    EXACT S(force_effect) y;
    y.acceleration = float3_add(sum.acceleration, effect.acceleration);
    y.pull = sum.pull + exact_max(effect.pull, 0.0f);
    return y;
}

FN S(force_effect) forces_sum(SIM_PARAM float3 position, float life)
{
    EXACT S(force_effect) sum;
    sum.acceleration = FLOAT3(0.0f, 0.0f, 0.0f);
    sum.pull = 0.0f;
    EXACT S(force_input) force;
    force.position = position;
    force.time_s = STEP(time_s);
    for (uint i = 0u; i < STEP(force_count); i++) {
        force.vector = value3_at(SIM_KEYS STEP(forces[i].vector), force.time_s, life);
        force.strength = value_at(SIM_KEYS STEP(forces[i].strength), force.time_s, life);
        force.drift = value3_at(SIM_KEYS STEP(forces[i].drift), force.time_s, life);
        force.pull = value_at(SIM_KEYS STEP(forces[i].pull), force.time_s, life);
        force.scale = value_at(SIM_KEYS STEP(forces[i].scale), force.time_s, life);
        force.octaves = STEP(forces[i].octaves);
        force.grid = STEP(forces[i].grid);
        force.seed = STEP(noise_seed);
        EXACT S(force_effect) effect = forces_one(SIM STEP(forces[i].kind), force);
        sum = forces_add(sum, effect);
    }
    return sum;
}

/* (1 - e^-z) / z for z >= 0 within 4e-7: by how much less than its time a pull of strength z acts.
 */
FN float forces_damping(float z)
{
    if (z < 0.25f) {
        EXACT float end = 0.00833333333f - z * (0.00138888889f - z * 0.000198412698f);
        EXACT float tail = 0.166666667f - z * (0.0416666667f - z * end);
        EXACT float series = 1.0f - z * (0.5f - z * tail);
        return series;
    }
    EXACT float minus_z = -z;
    EXACT float decay = exact_exp(minus_z);
    EXACT float done = 1.0f - decay;
    EXACT float damping = exact_div(done, z);
    return damping;
}

/* The velocity after `time_s`: the exact solution of dv/dt = acceleration - pull * v for constant
 * forces, v + (acceleration - pull * v) * (1 - e^(-pull * time)) / pull. It cannot overshoot. */
FN float3 forces_apply(S(force_effect) sum, float3 velocity, float time_s)
{
    EXACT float z = sum.pull * time_s;
    EXACT float acting_s = time_s * forces_damping(z);
    EXACT float slowing = -sum.pull;
    EXACT float3 change = float3_add_scaled(sum.acceleration, velocity, slowing);
    EXACT float3 y = float3_add_scaled(velocity, change, acting_s);
    return y;
}

#endif
