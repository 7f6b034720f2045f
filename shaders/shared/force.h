/* Declares the input and the result of every force. A force changes a velocity by dv/dt =
 * acceleration - pull * v. Drag is given as a pull, so that the sum of all forces is integrated
 * exactly over a step, and no pull, however strong, makes a particle overshoot. Drag by the square
 * of the speed adds - quadratic * |v| * v.
 *
 * A GLSL kernel with FORCES_ALL has all forces and integrators. One with FORCES_PLAIN has most
 * forces in a shorter form and compiles several times as fast. */
#ifndef KILN_SHARED_FORCE_H
#define KILN_SHARED_FORCE_H

#include "shared/exact.h"
#include "shared/layout.h"
#include "shared/uses.h"

#ifndef GL_core_profile
#define FORCES_ALL   1
#define FORCES_PLAIN 1
#elif !defined(FORCES_ALL)
#define FORCES_PLAIN 1
#endif

struct force_effect {
    float3 acceleration; /* m/s^2 */
    float pull;          /* 1/s, not negative */
    float quadratic;     /* 1/m, not negative */
};

/* The options of one force that vary over a particle's life, at one time of it. Kinds of force
 * share the members; struct kiln_force_params says what they are of each. */
struct force_values {
    float3 vector;
    float3 second;
    float strength;
    float pull;
    float quadratic; /* with FORCES_ALL only */
    float scale;
};

/* All options of one force at this time of one particle's life, and the place of the particle. */
struct force_input {
    float3 position;
    float time_s;
    S(force_values) at;
    float inward;
    float lift;
    float added;
    uint octaves;
    uint grid;
    uint profile;
    uint seed;
};

FN S(force_effect) force_none(void)
{
    EXACT S(force_effect) effect;
    effect.acceleration = FLOAT3(0.0f, 0.0f, 0.0f);
    effect.pull = 0.0f;
    effect.quadratic = 0.0f;
    return effect;
}

/* Returns the effect of air with a velocity, times the force's strength: the particle is pulled
 * towards the air's velocity. If `added`, the number of steps a second, is not 0, there is no pull,
 * and the air's velocity is added to the particle's in each step (UberFlow 2004, 4.2, equation
 * 1). */
FN S(force_effect) force_air(S(force_input) f, float3 air)
{
    EXACT float per_s = f.at.pull + f.added;
    EXACT float acceleration = f.at.strength * per_s;
    EXACT S(force_effect) effect = force_none();
    effect.acceleration = float3_scale(air, acceleration);
    effect.pull = f.at.pull;
    return effect;
}

/* Returns (1 - e^-z) / z for z >= 0 within 4e-7: the factor by which a pull shortens the time that
 * forces act, z being pull times time. */
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

/* Returns the time at which the forces of a step that starts at `time_s` are evaluated. Integrators
 * that evaluate them at several places use the middle of the step for all, where the host evaluates
 * values over time. */
FN float forces_time_s(SIM_PARAM float time_s)
{
#ifdef FORCES_ALL
    if (STEP_INTEGRATION >= INTEGRATE_TRAPEZOID) {
        EXACT float halfway_s = time_s + 0.5f * STEP(derived.dt_s);
        return halfway_s;
    }
#endif
    return time_s;
}

/* Returns a particle's clocks at a place of its way, where forces act on it. */
FN S(value_clocks) forces_clocks(SIM_PARAM float3 position, float3 velocity, S(value_clocks) clocks)
{
    EXACT S(value_clocks) here = clocks;
    here.time_s = forces_time_s(SIM STEP(time_s));
    here.height = position.y;
    here.velocity = velocity;
    return here;
}

#endif
