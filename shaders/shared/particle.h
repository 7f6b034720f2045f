/* Declares the record of a particle, 32 bytes that a simulation step reads and writes. All other
 * values of a particle (life, size, spin, texture) are recomputed from its serial and its birth;
 * the thesis stores 44 bytes (Heinz 2019, 3.2.2).
 *
 * Records are stored as integers. A driver may flush a denormal float or quieten a NaN when it
 * passes through a register, but it never changes an integer. */
#ifndef KILN_SHARED_PARTICLE_H
#define KILN_SHARED_PARTICLE_H

#include "shared/platform.h"

/* The most systems of a scene: as many as the bits of a draw entry can name. */
#define KILN_MAX_SYSTEMS 64

/* A draw entry packs the number of a system into the upper 6 bits of 32, and a slot of the whole
 * buffer of records into the lower 26. */
#define KILN_ENTRY_SLOT_BITS     26u
#define KILN_ENTRY(system, slot) (UINT(system) << KILN_ENTRY_SLOT_BITS | (slot))
#define KILN_ENTRY_SYSTEM(entry) ((entry) >> KILN_ENTRY_SLOT_BITS)
#define KILN_ENTRY_SLOT(entry)   ((entry) & ((1u << KILN_ENTRY_SLOT_BITS) - 1u))

/* The version of the steps. It is raised with every change of the state that steps compute, so that
 * states saved by earlier versions are not used. */
#define KILN_STATE_VERSION 1

struct kiln_particle {
    uint4 position_serial; /* position as float bits, metres; serial */
    uint4 velocity_birth;  /* velocity as float bits, metres a second, or a rest; birth word */
};

/* The spin of a particle, which is part of the state of systems that have spins. Systems whose
 * particles have children by the metre, or of more impacts than a birth word counts, have rows of
 * the same size in the same buffer for their ways, since GL guarantees no more buffers: rate.x is
 * 2^-32 metres, rate.y whole metres, rate.z impacts, the rest 0. */
struct kiln_spin {
    uint4 rate; /* float bits, rad/s, in the world; w: 0 */
    uint4 pose; /* float bits: a unit quaternion, from the ball to the world */
};

/* The birth word: step of birth (22 bits), 64ths of that step before the birth (6), flags (4). A
 * run of more steps than 22 bits hold is refused. */
#define KILN_PARTICLE_ALIVE       1u
#define KILN_PARTICLE_HIT         2u /* systems with children: one impact so far, ... */
#define KILN_PARTICLE_STOPPED     4u /* rests where it hit a surface (THEN_STOP, THEN_STICK) */
#define KILN_PARTICLE_HIT_TWICE   8u /* ... two more: together, a number of up to 3 */
#define KILN_BIRTH_STEP_SHIFT     10u
#define KILN_BIRTH_FRACTION_SHIFT 4u
#define KILN_BIRTH_FRACTION_MASK  63u
#define KILN_MAX_STEPS            4194303u

/* A particle that has stopped has no velocity of its own. Its three words of velocity hold its rest
 * instead: the 64ths of steps at which it stopped, counted as step * 64 + 64ths; 1 + the number of
 * the collider that it rides, or 0; and its heading (heading.h). */
#define KILN_REST_STEP_SHIFT 6u

FN bool particle_is_alive(S(kiln_particle) p)
{
    return (p.velocity_birth.w & KILN_PARTICLE_ALIVE) != 0u;
}

/* The most impacts that a birth word counts. */
#define KILN_PARTICLE_MOST_HITS 3u

/* Returns the number of impacts so far, of those that are counted (kiln_family_params). */
FN uint particle_hits(S(kiln_particle) p)
{
    return (p.velocity_birth.w >> 1u & 1u) + (p.velocity_birth.w >> 2u & 2u);
}

/* Returns the birth word of a particle with another number of impacts, 0 to 3. */
FN uint particle_birth_with_hits(uint birth, uint hits)
{
    uint others = birth & ~(KILN_PARTICLE_HIT | KILN_PARTICLE_HIT_TWICE);
    return others | (hits & 1u) << 1u | (hits & 2u) << 2u;
}

/* Returns whether a slot has a particle, or what is left of one. */
FN bool particle_is_there(S(kiln_particle) p)
{
    return p.velocity_birth.w != 0u;
}

/* Returns what is left of a particle that has died in a system whose children inherit its look: its
 * serial, and the time of its birth. */
FN S(kiln_particle) particle_remains(S(kiln_particle) p)
{
    uint birth = p.velocity_birth.w & ~((1u << KILN_BIRTH_FRACTION_SHIFT) - 1u);
    S(kiln_particle) left;
    left.position_serial = UINT4(0u, 0u, 0u, p.position_serial.w);
    left.velocity_birth = UINT4(0u, 0u, 0u, birth);
    return left;
}

FN uint particle_birth_step(S(kiln_particle) p)
{
    return p.velocity_birth.w >> KILN_BIRTH_STEP_SHIFT;
}

/* Returns the part of the birth step before the birth: 0 to 63/64. */
FN float particle_birth_fraction(S(kiln_particle) p)
{
    uint sixty_fourths =
        (p.velocity_birth.w >> KILN_BIRTH_FRACTION_SHIFT) & KILN_BIRTH_FRACTION_MASK;
    EXACT float fraction = FLOAT(sixty_fourths) * 0.015625f;
    return fraction;
}

/* Returns the age in seconds at the end of step `step`. Steps count from 1; a particle born in that
 * step has lived for the rest of it. One that is born at the start of the next step is 0 s old. */
FN float particle_age(S(kiln_particle) p, uint step, float dt_s)
{
    EXACT float steps = FLOAT(step + 1u - particle_birth_step(p));
    EXACT float lived = steps - particle_birth_fraction(p);
    EXACT float age = lived * dt_s;
    return age;
}

/* Returns the age in seconds `back` steps before the end of step `step`; below 0 before the
 * birth. */
FN float particle_age_before(S(kiln_particle) p, uint step, float back, float dt_s)
{
    EXACT float steps = FLOAT(step - particle_birth_step(p)) + 1.0f;
    EXACT float lived = steps - particle_birth_fraction(p);
    EXACT float until = lived - back;
    EXACT float age = until * dt_s;
    return age;
}

FN float3 particle_position(S(kiln_particle) p)
{
    EXACT float3 v = FLOAT3(BITS_FLOAT(p.position_serial.x), BITS_FLOAT(p.position_serial.y),
                            BITS_FLOAT(p.position_serial.z));
    return v;
}

FN bool particle_has_stopped(S(kiln_particle) p)
{
    return (p.velocity_birth.w & KILN_PARTICLE_STOPPED) != 0u;
}

/* Returns the velocity, m/s; 0 for a particle that has stopped. */
FN float3 particle_velocity(S(kiln_particle) p)
{
    uint mask = particle_has_stopped(p) ? 0u : 0xffffffffu;
    EXACT float3 v =
        FLOAT3(BITS_FLOAT(p.velocity_birth.x & mask), BITS_FLOAT(p.velocity_birth.y & mask),
               BITS_FLOAT(p.velocity_birth.z & mask));
    return v;
}

/* Returns for how long a particle has turned by itself at an age: one that has stopped has not
 * turned since. */
FN float particle_turned_s(S(kiln_particle) p, float age_s, float dt_s)
{
    if (!particle_has_stopped(p))
        return age_s;
    uint whole = (p.velocity_birth.x >> KILN_REST_STEP_SHIFT) - particle_birth_step(p);
    EXACT float part = FLOAT(p.velocity_birth.x & KILN_BIRTH_FRACTION_MASK) * 0.015625f;
    EXACT float steps = FLOAT(whole) + part;
    EXACT float lived = steps - particle_birth_fraction(p);
    EXACT float stopped_s = lived * dt_s;
    return stopped_s < age_s ? stopped_s : age_s;
}

#endif
