/* What every force is made of. A force changes a velocity by dv/dt = acceleration - pull * v: what
 * drags is given as a pull, so that the sum of all forces is integrated exactly over a step and no
 * pull, however strong, makes a particle overshoot. Drag by the square of the speed adds
 * - quadratic * |v| * v.
 *
 * In GLSL a kernel with FORCES_ALL knows all forces and integrators; one with FORCES_PLAIN, most of
 * them by a shorter way, compiles several times as fast.
 */
#ifndef KILN_SHARED_FORCE_H
#define KILN_SHARED_FORCE_H

#include "shared/exact.h"
#include "shared/layout.h"

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

/* The options of one force at this time of one particle's life, and where the particle is. */
struct force_input {
    float3 position;
    float time_s;
    float3 vector;
    float strength;
    float3 drift;
    float pull;
    float quadratic; /* with FORCES_ALL */
    float scale;
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

/* What air of a velocity, times the force's strength, does: it pulls towards itself; or, where
 * `added` is the number of steps a second, with no pull then, it is added to the velocity in each
 * step (UberFlow 2004, 4.2, equation 1). */
FN S(force_effect) force_air(S(force_input) f, float3 air)
{
    EXACT float per_s = f.pull + f.added;
    EXACT float acceleration = f.strength * per_s;
    EXACT S(force_effect) effect = force_none();
    effect.acceleration = float3_scale(air, acceleration);
    effect.pull = f.pull;
    return effect;
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

#endif
