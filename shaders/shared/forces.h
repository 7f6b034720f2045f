/* Sums up the forces of a system and integrates them. A new force is a file force_NAME.h with one
 * function, and a row in FORCES_MORE: kernels have it only in scenes that use one of these forces,
 * since fewer forces compile faster. FORCES has those that every kernel has. Forces that look up
 * grids have separate rows, since kernels of scenes without grids are compiled without them. A
 * limit is not summed and has no row. */
#ifndef KILN_SHARED_FORCES_H
#define KILN_SHARED_FORCES_H

#include "shared/force_curl.h"
#include "shared/force_drag.h"
#include "shared/force_gravity.h"
#include "shared/force_limit.h"
#include "shared/force_region.h"
#include "shared/force_wind.h"
#include "shared/still_frame.h"

#define FORCES(ROW)                                                                                \
    ROW(FORCE_GRAVITY, force_gravity)                                                              \
    ROW(FORCE_DRAG, force_drag)                                                                    \
    ROW(FORCE_WIND, force_wind)                                                                    \
    ROW(FORCE_CURL, force_curl)

#if defined(GL_core_profile) && !defined(GRIDS)
#define FORCES_OF_GRIDS(ROW)
#else
#include "shared/force_baked.h"
#include "shared/force_field.h"
#define FORCES_OF_GRIDS(ROW)                                                                       \
    ROW(FORCE_FIELD, force_field)                                                                  \
    ROW(FORCE_BAKED, force_baked)
#endif

#ifdef FORCES_ALL
#include "shared/force_attract.h"
#include "shared/force_vortex.h"
#define FORCES_MORE(ROW)                                                                           \
    ROW(FORCE_ATTRACT, force_attract)                                                              \
    ROW(FORCE_VORTEX, force_vortex)
#else
#define FORCES_MORE(ROW)
#endif

FN S(force_effect) forces_one(SIM_PARAM uint kind, S(force_input) force)
{
    EXACT S(force_effect) effect = force_none();
#define FORCES_ROW(id, function)                                                                   \
    if (USES(USES_FORCES, id) && kind == id)                                                       \
        effect = function(force);
    FORCES(FORCES_ROW)
    FORCES_MORE(FORCES_ROW)
#undef FORCES_ROW
#define FORCES_ROW(id, function)                                                                   \
    if (USES(USES_FORCES, id) && kind == id)                                                       \
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
    y.quadratic = sum.quadratic + exact_max(effect.quadratic, 0.0f);
    return y;
}

/* Returns whether force i is summed up alone before it is added to the others: it lies in a node,
 * out of which its effect must be turned, or it acts in a region alone. */
FN bool forces_stand_apart(SIM_PARAM uint i)
{
    bool attached = USES(USES_FORCES, FORCE_IN_NODE) && STEP(forces[i].frame.at.w) > 0.0f;
    return attached ||
           (USES(USES_FORCES, FORCE_IN_REGION) && STEP(forces[i].region) != REGION_NONE);
}

/* Returns how much of force i is left at a place in the world. */
FN float forces_weight(SIM_PARAM uint i, float3 position)
{
    EXACT float3 at = position;
    if (USES(USES_FORCES, FORCE_IN_NODE) && still_frame_is(STEP(forces[i].region_frame)))
        at = still_frame_inside(STEP(forces[i].region_frame), position);
    EXACT float weight = force_region_weight(
        at, STEP(forces[i].region), STEP(forces[i].region_center), STEP(forces[i].region_size));
    return weight;
}

/* Returns the effect in the world of force i, which stands apart, at a place in the world.
 * effect: in the node of the force. */
FN S(force_effect) forces_apart(SIM_PARAM uint i, float3 position, S(force_effect) effect)
{
    EXACT S(force_effect) y = forces_add(force_none(), effect);
    if (USES(USES_FORCES, FORCE_IN_NODE) && STEP(forces[i].frame.at.w) > 0.0f)
        y.acceleration = float3_turn(STEP(forces[i].frame.turn), y.acceleration);
    if (USES(USES_FORCES, FORCE_IN_REGION) && STEP(forces[i].region) != REGION_NONE) {
        EXACT float weight = forces_weight(SIM i, position);
        y = force_region_fade(y, weight);
    }
    return y;
}

/* The least radius and the least size of eddies that a scene may give, m. In a node of a small
 * scale they are not smaller either, since a particle near the middle would be thrown out. */
#define FORCE_LEAST_SIZE 0.001f

/* Returns a radius or a size of eddies in metres of the world. size: in the node of scale `scale`
 * that a force of this kind lies in. That of a grid has no least. */
FN float forces_size(uint kind, float size, float scale)
{
    EXACT float y = size * scale;
    EXACT float least = kind == FORCE_FIELD || kind == FORCE_BAKED ? 0.0f : FORCE_LEAST_SIZE;
    y = exact_max(y, least);
    return y;
}

/* Returns the input of force i for a particle at a place in the node of the force. values: the
 * force's options that vary over the particle's life. */
FN S(force_input) force_input_of(SIM_PARAM uint i, float3 position, S(force_values) values)
{
    EXACT S(force_input) force;
    force.position = position;
    force.time_s = forces_time_s(SIM STEP(time_s));
    force.at = values;
    force.inward = STEP(forces[i].inward);
    force.lift = STEP(forces[i].lift);
    force.added = STEP(forces[i].added);
    force.profile = STEP(forces[i].profile);
    force.octaves = STEP(forces[i].octaves);
    force.grid = STEP(forces[i].grid);
    force.seed = STEP(noise_seed);
    return force;
}

FN S(force_effect) forces_sum(SIM_PARAM float3 position, float3 velocity, S(value_clocks) clocks)
{
    EXACT S(force_effect) sum = force_none();
    EXACT S(value_clocks) here = forces_clocks(SIM position, velocity, clocks);
    EXACT S(force_values) values;
    for (uint i = 0u; i < STEP(force_count); i++) {
        values.vector = VALUE3_OF(KEYED_FORCE_VECTOR, SIM_KEYS STEP(forces[i].vector), here);
        values.second = VALUE3_OF(KEYED_FORCE_SECOND, SIM_KEYS STEP(forces[i].second), here);
        values.strength = VALUE_OF(KEYED_FORCE_STRENGTH, SIM_KEYS STEP(forces[i].strength), here);
        values.pull = VALUE_OF(KEYED_FORCE_PULL, SIM_KEYS STEP(forces[i].pull), here);
#ifdef FORCES_ALL
        values.quadratic =
            VALUE_OF(KEYED_FORCE_QUADRATIC, SIM_KEYS STEP(forces[i].quadratic), here);
#endif
        values.scale = VALUE_OF(KEYED_FORCE_SCALE, SIM_KEYS STEP(forces[i].scale), here);
        EXACT float3 at = position;
        if (USES(USES_FORCES, FORCE_IN_NODE) && still_frame_is(STEP(forces[i].frame))) {
            at = still_frame_inside(STEP(forces[i].frame), position);
            values.scale =
                forces_size(STEP(forces[i].kind), values.scale, STEP(forces[i].frame.at.w));
        }
        EXACT S(force_input) force = force_input_of(SIM i, at, values);
        EXACT S(force_effect) effect = forces_one(SIM STEP(forces[i].kind), force);
        if (forces_stand_apart(SIM i))
            effect = forces_apart(SIM i, position, effect);
        sum = forces_add(sum, effect);
    }
    return sum;
}

/* Returns the part of a time for which forces act against a pull. */
FN float forces_acting_s(float pull, float time_s)
{
    EXACT float z = pull * time_s;
    EXACT float acting_s = time_s * forces_damping(z);
    return acting_s;
}

/* Returns the velocity after `time_s`: the exact solution of dv/dt = acceleration - pull * v for
 * constant forces, v + (acceleration - pull * v) * (1 - e^(-pull * time)) / pull. It cannot
 * overshoot. */
FN float3 forces_apply(S(force_effect) sum, float3 velocity, float time_s)
{
    EXACT float acting_s = forces_acting_s(sum.pull, time_s);
    EXACT float slowing = -sum.pull;
    EXACT float3 change = float3_add_scaled(sum.acceleration, velocity, slowing);
    EXACT float3 y = float3_add_scaled(velocity, change, acting_s);
    return y;
}

#ifdef FORCES_ALL

/* Applies quadratic drag over `acting_s` to a velocity: the solution v of v + acting_s * quadratic
 * * |v| * v = velocity. After forces_apply with the same acting time, its equilibrium is exactly
 * where drag balances the other forces. A faster or slower particle approaches that speed without
 * passing it, however strong the drag. */
FN float3 forces_slow(float3 velocity, float quadratic, float acting_s)
{
    EXACT float speed = float3_length(velocity);
    EXACT float drag = quadratic * acting_s * speed;
    EXACT float grown = 1.0f + 4.0f * drag;
    EXACT float below = 1.0f + exact_sqrt(grown);
    EXACT float slower = exact_div(2.0f, below);
    slower = exact_min(slower, 1.0f);
    EXACT float factor = drag > 0.0f ? slower : 1.0f;
    EXACT float3 y = float3_scale(velocity, factor);
    return y;
}

#endif

#endif
