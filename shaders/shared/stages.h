/* Implements integrators that evaluate the forces at several places of a step, in stages. Each
 * stage gives the place of the next evaluation, and the last gives the end of the step. Kernels
 * that have these integrators run the other integrators here, too, as one stage, with the same bits
 * as step.h.
 *
 * All of them integrate pulls exactly: a step under constant forces gives the exact solution, and a
 * pull of any strength cannot overshoot (Cox and Matthews, "Exponential time differencing for stiff
 * systems", 2002). Without a pull
 * - `trapezoid` is UberFlow's (2004, 4.2, equation 2): a particle moves by the mean of its
 *   velocities before and after the step. The paper takes the force at the start of the step. Here
 *   it is the mean of the forces at the start and at the place where that leads. This makes it
 *   second order where forces depend on places, and changes nothing where they do not;
 * - `rk4` is the classical Runge-Kutta method of fourth order.
 *
 * Quadratic drag is evaluated as one of the forces. It is stiff, so the result changes over to that
 * of forces_slow as drag takes more of the velocity in a step. */
#ifndef KILN_SHARED_STAGES_H
#define KILN_SHARED_STAGES_H

#include "shared/forces.h"

struct stages {
    float3 position, velocity;  /* at the start of the step */
    float3 at, moving;          /* place of the next evaluation of forces, and the velocity there */
    float3 acceleration, first; /* at the start; `first` is less the quadratic drag */
    float3 early;               /* velocity at the first evaluation in the middle */
    /* sum of the differences of the forces in the middle from those at the start */
    float3 changed;
    float3 flown;          /* velocities of the stages, weighted in sixths */
    float pull, quadratic; /* at the start */
    float fastest;         /* m/s: fastest of the stages */
    float trust;           /* trust in the last stage: see stages_trust */
};

/* Returns the number of evaluations of forces in a step. */
FN uint stages_count(uint integration)
{
    if (integration == INTEGRATE_RK4)
        return 4u;
    return integration == INTEGRATE_TRAPEZOID ? 2u : 1u;
}

FN S(stages) stages_start(float3 position, float3 velocity)
{
    EXACT S(stages) s;
    s.position = position;
    s.velocity = velocity;
    s.at = position;
    s.moving = velocity;
    s.acceleration = FLOAT3(0.0f, 0.0f, 0.0f);
    s.first = s.acceleration;
    s.early = s.acceleration;
    s.changed = s.acceleration;
    s.flown = s.acceleration;
    s.pull = 0.0f;
    s.quadratic = 0.0f;
    s.fastest = 0.0f;
    s.trust = 0.0f;
    return s;
}

/* Returns the trust in results that are not made for stiff drag. It is 1 for small parts z of the
 * velocity that drag takes in the step, 0 from 1 on, and in between close enough to 1 to keep the
 * order of accuracy. 0 for NaN. */
FN float stages_trust(float z)
{
    EXACT float square = z * z;
    EXACT float left = 1.0f - square * square;
    bool below_one = FLOAT_BITS(z) < 0x3f800000u; /* compares bits, so that NaN is not below one */
    EXACT float trust = below_one ? left : 0.0f;
    return trust;
}

/* Returns b as far as it is trusted, else a. It is not a plain weighted sum, since b may be NaN. */
FN float3 stages_mix(float3 a, float3 b, float trust)
{
    EXACT float3 difference = float3_sub(b, a);
    EXACT float3 mixed = float3_add_scaled(a, difference, trust);
    bool any = trust > 0.0f;
    EXACT float3 y = FLOAT3(any ? mixed.x : a.x, any ? mixed.y : a.y, any ? mixed.z : a.z);
    return y;
}

/* Weights of the forces over a step with a pull of z: (1 - e^-z) / z, then each (1/n! - the one
 * before) / z, with the limits 1, 1/2 and 1/6 for z = 0. Their relative error is 2e-6. */
struct stages_weights {
    float one, two, three;
};

FN S(stages_weights) stages_weigh(float z)
{
    EXACT S(stages_weights) w;
    EXACT float held = exact_min(z, 1.0f);
    EXACT float end = 0.000198412698f - held * (2.48015873e-5f - held * 2.75573192e-6f);
    EXACT float tail = 0.00833333333f - held * (0.00138888889f - held * end);
    EXACT float series = 0.166666667f - held * (0.0416666667f - held * tail);
    EXACT float near_two = 0.5f - held * series;
    w.one = forces_damping(z);
    EXACT float rest_one = 1.0f - w.one;
    EXACT float far_two = exact_div(rest_one, z);
    EXACT float rest_two = 0.5f - far_two;
    EXACT float far_three = exact_div(rest_two, z);
    w.two = z < 1.0f ? near_two : far_two;
    w.three = z < 1.0f ? series : far_three;
    return w;
}

/* Returns the effect of the forces at s.at, except the pull at the start. */
FN float3 stages_rest(S(stages) s, S(force_effect) e)
{
    EXACT float speed = float3_length(s.moving);
    EXACT float more = e.pull - s.pull;
    EXACT float slowing = -(more + e.quadratic * speed);
    EXACT float3 y = float3_add_scaled(e.acceleration, s.moving, slowing);
    return y;
}

/* Moves to the place of the next stage. For rk4: half of the step by the first velocity, then half
 * by the one found there, then all of it by the next. */
FN S(stages) stages_onward(S(stages) s, float3 rest, uint stage, uint count, float time_s)
{
    bool rk4 = count == 4u;
    bool third = stage == 2u;
    EXACT float weight = stage == 0u ? 1.0f : 2.0f;
    s.flown = float3_add_scaled(s.flown, s.moving, weight);
    EXACT float3 difference = float3_sub(rest, s.first);
    s.changed = float3_add(s.changed, difference);

    EXACT float half_s = 0.5f * time_s;
    EXACT float acting_s = rk4 ? half_s : time_s;
    EXACT float3 later = float3_add(rest, difference);
    EXACT float3 before = third ? s.early : s.velocity;
    EXACT S(force_effect) effect = force_none();
    effect.acceleration = third ? later : rest;
    effect.pull = s.pull;
    EXACT float3 next = forces_apply(effect, before, acting_s);

    EXACT float3 both = float3_add(s.velocity, next);
    EXACT float3 carrying = rk4 ? s.moving : both;
    EXACT float flying_s = third ? time_s : half_s;
    s.at = float3_add_scaled(s.position, carrying, flying_s);
    s.early = s.moving;
    s.moving = next;
    return s;
}

/* Computes the velocity at the end of the step. */
FN S(stages) stages_finish(S(stages) s, float3 rest, uint count, float time_s)
{
    bool rk4 = count == 4u;
    s.flown = float3_add(s.flown, s.moving);
    EXACT float z = s.pull * time_s;
    EXACT S(stages_weights) w = stages_weigh(z);
    EXACT float slowing = -s.pull;

    EXACT float acting_s = time_s * w.one; /* as forces_acting_s */
    EXACT float3 change = float3_add_scaled(s.acceleration, s.velocity, slowing);
    EXACT float3 stiff = float3_add_scaled(s.velocity, change, acting_s);
    stiff = forces_slow(stiff, s.quadratic, acting_s);

    EXACT float middle = 2.0f * w.two - 4.0f * w.three;
    EXACT float end = 4.0f * w.three - w.two;
    EXACT float last = rk4 ? end : w.two;
    middle = rk4 ? middle : 0.0f;
    EXACT float3 difference = float3_sub(rest, s.first);
    EXACT float3 rate = float3_add_scaled(s.first, s.velocity, slowing);
    rate = float3_scale(rate, w.one);
    rate = float3_add_scaled(rate, s.changed, middle);
    rate = float3_add_scaled(rate, difference, last);
    EXACT float3 accurate = float3_add_scaled(s.velocity, rate, time_s);

    EXACT float dragged = s.quadratic * s.fastest * time_s;
    EXACT float trust = stages_trust(dragged);
    s.trust = count == 1u ? 0.0f : trust;
    s.moving = stages_mix(stiff, accurate, s.trust);
    return s;
}

/* Adds the effect of the forces at s.at. After the last stage, s.moving is the particle's
 * velocity. */
FN S(stages) stages_take(S(stages) s, S(force_effect) e, uint stage, uint count, float time_s)
{
    if (stage == 0u) {
        s.acceleration = e.acceleration;
        s.pull = e.pull;
        s.quadratic = e.quadratic;
    }
    EXACT float speed = float3_length(s.moving);
    s.fastest = exact_max(s.fastest, speed);
    EXACT float3 rest = stages_rest(s, e);
    if (stage == 0u)
        s.first = rest;
    if (stage + 1u < count)
        return stages_onward(s, rest, stage, count, time_s);
    return stages_finish(s, rest, count, time_s);
}

/* Returns the place at the end of the step. */
FN float3 stages_arrive(S(stages) s, uint integration, float time_s)
{
    bool first = integration == INTEGRATE_POSITION_FIRST;
    bool mean = integration >= INTEGRATE_TRAPEZOID;
    EXACT float3 both = float3_add(s.velocity, s.moving);
    EXACT float3 carrying = first ? s.velocity : s.moving;
    carrying = mean ? both : carrying;
    EXACT float half_s = 0.5f * time_s;
    EXACT float flying_s = mean ? half_s : time_s;
    EXACT float3 plain = float3_add_scaled(s.position, carrying, flying_s);

    EXACT float sixth_s = 0.166666667f * time_s;
    EXACT float3 flown = float3_add_scaled(s.position, s.flown, sixth_s);
    EXACT float3 mixed = stages_mix(plain, flown, s.trust);
    EXACT float3 y = integration == INTEGRATE_RK4 ? mixed : plain;
    return y;
}

#endif
