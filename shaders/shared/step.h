/* Runs one step of one slot: birth, forces, motion, collision, death. Every simulation technique
 * runs this code and only moves data around it (docs/determinism.md, 1). */
#ifndef KILN_SHARED_STEP_H
#define KILN_SHARED_STEP_H

#include "shared/emit.h"
#include "shared/family.h"
#include "shared/push.h"
#include "shared/still_frame.h"
#include "shared/sweep.h"

/* Returns whether particles of the system meet colliders. */
#define STEP_COLLIDES                                                                              \
    ((USES(USES_COLLIDE, COLLIDE_SWEPT) || USES(USES_COLLIDE, COLLIDE_CLAMP)) &&                   \
     STEP(collide) != COLLIDE_OFF)

/* Limit of places, m, and velocities, m/s: 2^20. A particle beyond it, or with a NaN, is lost. */
#define STEP_ABSURD_BITS 0x49800000u

FN bool step_is_sane(float3 v)
{
    return (FLOAT_BITS(v.x) & EXACT_SIZE_BITS) <= STEP_ABSURD_BITS &&
           (FLOAT_BITS(v.y) & EXACT_SIZE_BITS) <= STEP_ABSURD_BITS &&
           (FLOAT_BITS(v.z) & EXACT_SIZE_BITS) <= STEP_ABSURD_BITS;
}

FN bool step_is_between(float3 p, float4 low, float4 high)
{
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z &&
           p.z <= high.z;
}

/* Returns whether a place is outside of the bounding volume, or in a demitter (Heinz 2019,
 * 2.1.2). */
FN bool step_is_removed(SIM_PARAM float3 p)
{
    bool removed = STEP(bounded) != 0u && !step_is_between(p, STEP(bounds_min), STEP(bounds_max));
    for (uint i = 0u; i < STEP(demitter_count); i++) {
        EXACT float3 at = p;
        if (USES(USES_DEMITTERS, DEMITTER_IN_NODE) && still_frame_is(STEP(demitter_frames[i])))
            at = still_frame_inside(STEP(demitter_frames[i]), p);
        removed = removed || step_is_between(at, STEP(demitter_min[i]), STEP(demitter_max[i]));
    }
    return removed;
}

FN S(kiln_particle) step_dead(void)
{
    S(kiln_particle) p;
    p.position_serial = UINT4(0u, 0u, 0u, 0u);
    p.velocity_birth = UINT4(0u, 0u, 0u, 0u);
    return p;
}

FN S(kiln_particle) step_with_motion(S(kiln_particle) p, float3 position, float3 velocity)
{
    EXACT float3 x = float3_canon(position);
    EXACT float3 v = float3_canon(velocity);
    S(kiln_particle) moved;
    moved.position_serial =
        UINT4(FLOAT_BITS(x.x), FLOAT_BITS(x.y), FLOAT_BITS(x.z), p.position_serial.w);
    moved.velocity_birth =
        UINT4(FLOAT_BITS(v.x), FLOAT_BITS(v.y), FLOAT_BITS(v.z), p.velocity_birth.w);
    return moved;
}

/* Returns the particle of birth number `index` of this step at the time of its birth. */
FN S(kiln_particle) step_birth(SIM_PARAM uint index)
{
    S(kiln_particle) p = step_dead();
    EXACT S(emit_time) time = emit_birth_time(SIM index);
    p.position_serial.w = STEP(first_serial) + index;
    p.velocity_birth.w = (STEP(step) << KILN_BIRTH_STEP_SHIFT) |
                         (time.sixty_fourths << KILN_BIRTH_FRACTION_SHIFT) | KILN_PARTICLE_ALIVE;
    uint stream = particle_stream(STEP(derived), p);
    EXACT float born_s = particle_birth_time_at(STEP(derived), p, time.place);
    EXACT float order = emit_order(SIM index);
    EXACT S(emit_state) born =
        emit_particle(SIM stream, p.position_serial.w, born_s, time.place, order);
    return step_with_motion(p, born.position, born.velocity);
}

/* Returns the clocks of a particle at the start of this step, or at its birth in it. */
FN S(value_clocks) step_clocks(SIM_PARAM S(kiln_particle) p, float age_s, float life_s)
{
    bool born = particle_birth_step(p) == STEP(step);
    EXACT float age_before_s = age_s - STEP(derived.dt_s);
    EXACT float progress = particle_progress(age_before_s, life_s);
    EXACT float3 position = particle_position(p);
    EXACT float time_s = STEP(time_s);
    EXACT S(value_clocks) clocks =
        value_clocks_at(time_s, STEP(derived.random_key), STEP(derived.scene_key));
    clocks.life = born ? 0.0f : progress;
    clocks.age_s = born ? 0.0f : age_before_s;
    clocks.height = position.y;
    clocks.velocity = particle_velocity(p);
    clocks.stream = particle_stream(STEP(derived), p);
    return clocks;
}

/* Returns the options for impacts in this step. */
FN S(collide_answer) step_answer(SIM_PARAM S(value_clocks) clocks, float radius)
{
    EXACT S(collide_answer) answer;
    answer.randomness = VALUE_OF(KEYED_RANDOMNESS, SIM_KEYS STEP(randomness), clocks);
    answer.slowdown = VALUE_OF(KEYED_SLOWDOWN, SIM_KEYS STEP(slowdown), clocks);
    answer.stream = clocks.stream;
    answer.purpose = 0u;
    answer.rubs = STEP(rubs) != 0u;
    answer.restitution = 1.0f;
    answer.friction = 0.0f;
    if (COLLIDE_RUBS(answer)) {
        answer.restitution = VALUE_OF(KEYED_RESTITUTION, SIM_KEYS STEP(restitution), clocks);
        answer.friction = VALUE_OF(KEYED_FRICTION, SIM_KEYS STEP(friction), clocks);
    }
    answer.radius = radius;
    answer.spins = STEP(spins) != 0u && radius > 0.0f;
    answer.grip = answer.friction;
    answer.rolling = STEP(rolling);
    if (COLLIDE_SPINS(answer))
        answer.friction = 0.0f;
    return answer;
}

/* A particle's way from its start to the part `until` of the step. */
struct step_way {
    S(collide_state) start;
    S(collide_state) end;
    S(collide_touch) first; /* first impact */
    bool lost;              /* the particle has reached a place where it dies */
    bool stops;             /* an impact stops the particle for the rest of its life */
};

#if !defined(GL_core_profile) || defined(SPINS)

/* Returns the spin of a particle: its present one plus its push, or the one that it is born
 * with. */
FN float3 step_spin(SIM_PARAM S(kiln_particle) p, uint slot)
{
    uint at = (STEP(first_spin) + slot) * 2u;
    EXACT float3 rate = spin_rate(SPIN_WORD(at));
    if (particle_birth_step(p) == STEP(step)) {
        EXACT float3 axis = FLOAT3(STEP(spin_axis.x), STEP(spin_axis.y), STEP(spin_axis.z));
        rate =
            spin_at_birth(particle_stream(STEP(derived), p), STEP(spin_low), STEP(spin_high), axis);
    }
    return rate;
}

/* Turns a ball by its spin at the end of the step, and stores pose and spin. The pose affects no
 * motion. */
FN void step_turn(SIM_PARAM S(kiln_particle) p, uint slot, float3 rate)
{
    uint at = (STEP(first_spin) + slot) * 2u;
    EXACT float4 pose = spin_pose(SPIN_WORD(at + 1u));
    EXACT float time_s = STEP(derived.dt_s);
    if (particle_birth_step(p) == STEP(step)) {
        EXACT float part = 1.0f - particle_birth_fraction(p);
        time_s = time_s * part;
        pose = spin_any_pose(particle_stream(STEP(derived), p));
    }
    EXACT float4 rotated = spin_integrate(pose, rate, time_s);
    SPIN_WORD(at) = spin_words_of(rate);
    SPIN_WORD(at + 1u) = spin_pose_words(rotated);
}

#endif

/* Returns how far the system's node would carry a particle in a whole step, at the pace of its way,
 * m. */
FN float3 step_carried(SIM_PARAM S(step_way) way)
{
    EXACT float3 carried = FLOAT3(0.0f, 0.0f, 0.0f);
    if (!CARRY_HAPPENS)
        return carried;
    carried = carry_way(SIM way.start.position, way.start.since, way.end.since);
    EXACT float part = way.end.since - way.start.since;
    if (part > 0.0f && part < 1.0f) {
        EXACT float times = exact_div(1.0f, part);
        carried = float3_scale(carried, times);
    }
    return carried;
}

/* Follows a way among the colliders, and records its first impact. */
FN S(collide_way) step_collide(SIM_PARAM S(step_way) way, float3 push, S(value_clocks) clocks,
                               S(collide_answer) answer)
{
    EXACT S(collide_way) bounced;
    EXACT S(collide_state) start = way.start;
    EXACT float3 carried = step_carried(SIM way);
    if (USES(USES_COLLIDE, COLLIDE_CLAMP) && STEP(collide) == COLLIDE_CLAMP) {
        start.velocity = carry_to_world(SIM way.end.velocity, carried, 1.0f);
        bounced = collide_clamp(SIM start, way.end.position, way.end.since, answer);
        if (!bounced.first.happened) {
            bounced.end.velocity = way.end.velocity; /* not a bit of it changes */
            return bounced;
        }
        bounced.end.velocity = carry_to_world(SIM bounced.end.velocity, carried, -1.0f);
        bounced.first.velocity = carry_to_world(SIM bounced.first.velocity, carried, -1.0f);
        return bounced;
    }
    bounced = sweep(SIM start, way.end, push, carried, clocks, answer);
    if (SWEEP_POSITION_FIRST) {
        start.velocity = bounced.end.velocity;
        start = integrate(SIM start, way.end.since, clocks);
        bounced.end.velocity = start.velocity;
    }
    return bounced;
}

/* Collides on a way that is already known without colliders. */
FN S(step_way) step_meet(SIM_PARAM S(step_way) flown, S(step_push) push, S(value_clocks) clocks)
{
    EXACT S(step_way) way = flown;
    if (!step_is_sane(way.end.position) || !step_is_sane(way.end.velocity))
        return way;
    if (STEP_COLLIDES) {
        EXACT S(collide_answer) answer = step_answer(SIM clocks, push.radius);
        EXACT S(collide_way) bounced = step_collide(SIM way, push.position, clocks, answer);
        way.end = bounced.end;
        way.first = bounced.first;
        if (!step_is_sane(way.end.position) || !step_is_sane(way.end.velocity))
            return way;
    }
    way.lost = step_is_removed(SIM way.end.position);
    return way;
}

FN S(step_way) step_move(SIM_PARAM S(kiln_particle) p, S(step_push) push, float age_s, float life_s,
                         float until)
{
    bool born = particle_birth_step(p) == STEP(step);
    EXACT S(value_clocks) clocks = step_clocks(SIM p, age_s, life_s);

    EXACT S(step_way) way;
    way.start.position = particle_position(p);
    EXACT float3 velocity = particle_velocity(p);
    way.start.since = born ? particle_birth_fraction(p) : 0.0f;
    velocity = carry_velocity(SIM velocity, way.start.since, until);
    way.start.velocity = push_faster(push, velocity);
    way.start.spin = FLOAT3(0.0f, 0.0f, 0.0f);
#if !defined(GL_core_profile) || defined(SPINS)
    if (STEP(spins) != 0u)
        way.start.spin = step_spin(SIM p, push.slot);
#endif
    way.end = integrate(SIM way.start, until, clocks);
    way.end.position = push_farther(push, way.end.position);
    if (CARRY_HAPPENS) {
        EXACT float3 carried = carry_way(SIM way.start.position, way.start.since, until);
        way.end.position = float3_add(way.end.position, carried);
    }
    way.first = collide_no_touch();
    way.lost = true;
    way.stops = false;
    way = step_meet(SIM way, push, clocks);
#if !defined(GL_core_profile) || defined(SPINS)
    if (STEP(spins) != 0u && !way.lost)
        step_turn(SIM p, push.slot, way.end.spin);
#endif
    return way;
}

/* Returns a particle, which may be new, at the end of this step: moved, or dead. */
FN S(kiln_particle) step_particle(SIM_PARAM S(kiln_particle) p, S(step_push) push)
{
    EXACT float life_s = particle_life_s(SIM_KEYS STEP(derived), p);
    EXACT float age_s = particle_age(p, STEP(step), STEP(derived.dt_s));
    if (age_s >= life_s)
        return step_dead();
    EXACT S(step_way) way = step_move(SIM p, push, age_s, life_s, 1.0f);
    if (way.lost)
        return step_dead();
    return step_with_motion(p, way.end.position, way.end.velocity);
}

/* Returns the birth of this step that a slot is for; none if the index is not below birth_count. */
FN uint step_birth_index(SIM_PARAM uint slot)
{
    return slot >= STEP(first_slot) ? slot - STEP(first_slot)
                                    : slot + (STEP(capacity) - STEP(first_slot));
}

/* Returns the content of slot `slot` of the system after this step; `old` is its content before. */
FN S(kiln_particle) step_slot(SIM_PARAM uint slot, S(kiln_particle) old)
{
    uint index = step_birth_index(SIM slot);
    S(kiln_particle) p = old;
    if (index < STEP(birth_count))
        p = step_birth(SIM index);
    if (!particle_is_alive(p))
        return p;
    EXACT S(step_push) push = push_of(SIM slot);
    return step_particle(SIM p, push);
}

#endif
