/* Computes particles at a time within a step from the states before and after the step. Pictures of
 * moments of an open shutter show them; the states stay as they are.
 *
 * A particle that lives through the step is on the straight line between its two positions. Where
 * its acceleration is a, that is at most a dt^2 / 8 from the curve through them: 0.3 mm under
 * gravity at 60 steps a second. Where it bounces, its way cuts the corner before the surface, and
 * so never enters a flat or hollow one. A particle that is born in the step comes back along its
 * velocity after the step, and one that dies goes on along its velocity before the step. Such a way
 * knows no collision, so it may enter a surface by less than the way of a step. */
#ifndef KILN_SHARED_BETWEEN_H
#define KILN_SHARED_BETWEEN_H

#include "shared/derived.h"
#include "shared/spin.h"

/* Returns a particle at another place, with another velocity unless it has stopped. */
FN S(kiln_particle) between_with_motion(S(kiln_particle) p, float3 position, float3 velocity)
{
    S(kiln_particle) moved;
    moved.position_serial = UINT4(FLOAT_BITS(position.x), FLOAT_BITS(position.y),
                                  FLOAT_BITS(position.z), p.position_serial.w);
    moved.velocity_birth = UINT4(FLOAT_BITS(velocity.x), FLOAT_BITS(velocity.y),
                                 FLOAT_BITS(velocity.z), p.velocity_birth.w);
    if (particle_has_stopped(p))
        moved.velocity_birth = p.velocity_birth;
    return moved;
}

FN S(kiln_particle) between_none(void)
{
    S(kiln_particle) none;
    none.position_serial = UINT4(0u, 0u, 0u, 0u);
    none.velocity_birth = UINT4(0u, 0u, 0u, 0u);
    return none;
}

/* Returns whether a slot holds one particle before and after the step. */
FN bool between_lives_on(S(kiln_particle) before, S(kiln_particle) after)
{
    return particle_is_alive(before) && particle_is_alive(after) &&
           before.position_serial.w == after.position_serial.w;
}

/* Returns what moves on from a; at is 0 there and 1 at b. */
FN float3 between_mix(float3 a, float3 b, float at)
{
    EXACT float3 way = float3_sub(b, a);
    EXACT float3 y = float3_add_scaled(a, way, at);
    return y;
}

/* Returns the particle of a slot `back` steps before the end of step `step`; before, after: its
 * records at the start and at the end of this step. It is not alive if it is not born yet or dead;
 * what is left of a dead particle stays. */
FN S(kiln_particle) particle_between(VALUE_KEYS_PARAM S(kiln_derived_params) d,
                                     S(kiln_particle) before, S(kiln_particle) after, uint step,
                                     float back)
{
    EXACT float3 position = particle_position(after);
    EXACT float3 velocity = particle_velocity(after);
    if (between_lives_on(before, after)) {
        EXACT float3 position_before = particle_position(before);
        EXACT float3 velocity_before = particle_velocity(before);
        position = between_mix(position, position_before, back);
        velocity = between_mix(velocity, velocity_before, back);
        return between_with_motion(after, position, velocity);
    }
    if (particle_is_alive(after)) {
        EXACT float time_s = back * d.dt_s;
        EXACT float way_back_s = -time_s;
        EXACT float age_s = particle_age_before(after, step, back, d.dt_s);
        if (age_s < 0.0f)
            return between_none();
        position = float3_add_scaled(position, velocity, way_back_s);
        return between_with_motion(after, position, velocity);
    }
    if (particle_is_alive(before)) {
        EXACT float part = 1.0f - back;
        EXACT float time_s = part * d.dt_s;
        EXACT float age_s = particle_age_before(before, step, back, d.dt_s);
        EXACT float life_s = particle_life_s(VALUE_KEYS d, before);
        if (age_s >= life_s)
            return after;
        position = particle_position(before);
        velocity = particle_velocity(before);
        position = float3_add_scaled(position, velocity, time_s);
        return between_with_motion(before, position, velocity);
    }
    return after;
}

/* Returns the spin of a slot at that time: its pose is turned by its rate, which is constant in a
 * step, from the side on which the particle lives. */
FN S(kiln_spin) spin_between(S(kiln_particle) after, S(kiln_spin) spin_before,
                             S(kiln_spin) spin_after, float dt_s, float back)
{
    S(kiln_spin) spin = spin_before;
    EXACT float part = 1.0f - back;
    EXACT float time_s = part * dt_s;
    EXACT float3 rate = spin_rate(spin_before.rate);
    if (particle_is_alive(after)) {
        spin = spin_after;
        rate = spin_rate(spin_after.rate);
        rate = float3_scale(rate, -1.0f);
        time_s = back * dt_s;
    }
    EXACT float4 pose = spin_pose(spin.pose);
    pose = spin_integrate(pose, rate, time_s);
    spin.pose = spin_pose_words(pose);
    return spin;
}

#endif
