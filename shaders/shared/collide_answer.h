/* Computes how a particle's velocity changes at an impact on a surface: as in the thesis (Heinz
 * 2019, 3.5), or with restitution and friction. Balls that spin have friction on their surface
 * (shared/spin.h). */
#ifndef KILN_SHARED_COLLIDE_ANSWER_H
#define KILN_SHARED_COLLIDE_ANSWER_H

#include "shared/collide_oriented.h"
#include "shared/random.h"
#include "shared/spin.h"

/* Shaders of scenes without restitution and friction are compiled without their code. */
#if defined(GL_core_profile) && !defined(COLLIDE_RUB)
#define COLLIDE_RUBS(answer) false
#else
#define COLLIDE_RUBS(answer) ((answer).rubs)
#endif

/* Shaders of scenes without balls that spin are compiled without their code. */
#if defined(GL_core_profile) && !defined(SPINS)
#define COLLIDE_SPINS(answer) false
#else
#define COLLIDE_SPINS(answer) ((answer).spins)
#endif

/* Returns the outward normal of a face that collide_face_met returned. */
FN float3 collide_normal_of(uint face)
{
    EXACT float3 zero = FLOAT3(0.0f, 0.0f, 0.0f);
    EXACT float out_sign = (face & 1u) != 0u ? 1.0f : -1.0f;
    EXACT float3 y = collide_with_component(zero, face >> 1u, out_sign);
    if (face >= COLLIDE_FACES)
        y = collide_unpack_normal(face);
    return y;
}

/* Options for the answer to an impact. */
struct collide_answer {
    float randomness; /* 0 mirror .. 1 any direction of the hemisphere */
    float slowdown;   /* factor on the speed */
    uint stream;      /* random stream of the particle */
    uint purpose;     /* purpose of the two random numbers of this impact */
    bool rubs;        /* the members below count: restitution and friction */
    float restitution;
    float friction;
    float radius; /* m: distance of its centre from a surface that it touches */
    bool spins;   /* a ball that spins: friction acts on its surface at the contact */
    float grip;
    float rolling; /* rolling resistance: its lever arm, in radii */
};

/* Applies the factors of a collider to the options of a particle. */
FN S(collide_answer) collide_answer_of(S(collide_answer) answer, S(kiln_collider) c)
{
    EXACT S(collide_answer) y = answer;
    if (COLLIDE_RUBS(answer)) {
        y.restitution = answer.restitution * c.restitution;
        y.friction = answer.friction * c.friction;
        y.grip = answer.grip * c.friction;
    }
    return y;
}

/* Applies restitution to the normal part of a mirrored velocity, and Coulomb's friction to the
 * rest. Friction reduces the tangential velocity by at most its coefficient times the change of the
 * normal velocity, and never reverses it. */
FN_APART float3 collide_rubbed(float restitution, float friction, float3 mirrored, float3 normal,
                               float outwards)
{
    EXACT float inwards = -outwards;
    EXACT float3 aside = float3_add_scaled(mirrored, normal, inwards);
    EXACT float speed = float3_length(aside);
    EXACT float given = outwards * (1.0f + restitution);
    EXACT float slower = speed - friction * given;
    EXACT float quotient = exact_div(slower, speed);
    EXACT float remaining = exact_clamp(quotient, 0.0f, 1.0f);
    EXACT float returned = outwards * restitution;
    EXACT float3 along = float3_scale(normal, returned);
    EXACT float3 y = float3_add_scaled(along, aside, remaining);
    return y;
}

/* Returns the velocity, relative to the surface, after an impact that mirrored it: a linear
 * combination of the mirrored and a random direction, with the slowed speed. The random direction
 * lies in the hemisphere about the surface's normal, so that it never points inwards; with
 * `literal`, it lies in the hemisphere about the mirrored direction. outwards: the component along
 * the normal before the impact, m/s, below 0. */
FN float3 collide_scatter(S(collide_answer) answer, float3 velocity, float3 reflected,
                          float3 normal, float outwards, bool literal)
{
    EXACT float3 mirrored = reflected;
    EXACT float square = float3_dot(velocity, velocity);
    if (COLLIDE_RUBS(answer)) {
        EXACT float returned = -outwards;
        mirrored = collide_rubbed(answer.restitution, answer.friction, mirrored, normal, returned);
        square = float3_dot(mirrored, mirrored);
    }
    EXACT float speed = exact_sqrt(square);
    EXACT float3 straight = float3_normalize(mirrored, normal);
    EXACT float3 pole = normal;
    if (literal)
        pole = straight;
    EXACT float3 astray = random_direction(answer.stream, answer.purpose, pole, 0.0f);
    EXACT float straight_part = 1.0f - answer.randomness;
    EXACT float3 part = float3_scale(straight, straight_part);
    EXACT float3 mixed = float3_add_scaled(part, astray, answer.randomness);
    EXACT float3 direction = float3_normalize(mixed, straight);
    EXACT float slowed = speed * answer.slowdown;
    EXACT float3 y = float3_scale(direction, slowed);
    return y;
}

/* Returns the velocity, relative to the box, after an impact on one of its faces. */
FN float3 collide_bounce(S(collide_answer) answer, float3 velocity, uint face, bool literal)
{
    uint axis = face >> 1u;
    EXACT float out_sign = (face & 1u) != 0u ? 1.0f : -1.0f;
    EXACT float across = collide_component(velocity, axis);
    EXACT float outwards = across * out_sign;
    if (outwards >= 0.0f)
        return velocity;
    EXACT float3 mirrored = collide_with_component(velocity, axis, -across);
    EXACT float3 zero = FLOAT3(0.0f, 0.0f, 0.0f);
    EXACT float3 normal = collide_with_component(zero, axis, out_sign);
    EXACT float3 y = collide_scatter(answer, velocity, mirrored, normal, outwards, literal);
    return y;
}

/* Returns the velocity after an impact, as collide_bounce, for a surface of any direction. */
FN_CLOSE float3 collide_bounce_off(S(collide_answer) answer, float3 velocity, float3 normal,
                                   bool literal)
{
    EXACT float outwards = float3_dot(velocity, normal);
    if (outwards >= 0.0f)
        return velocity;
    EXACT float twice = -2.0f * outwards;
    EXACT float3 mirrored = float3_add_scaled(velocity, normal, twice);
    EXACT float3 y = collide_scatter(answer, velocity, mirrored, normal, outwards, literal);
    return y;
}

struct collide_state {
    float3 position;
    float3 velocity;
    float since; /* part of the step that has passed */
    float3 spin; /* rad/s, of balls that spin */
};

/* Returns the change of a ball's spin by rolling resistance, for a rate relative to the surface
 * that changed its normal velocity by `given` m/s. It never reverses the rate. */
FN float3 collide_rolling(S(collide_answer) answer, float3 rate, float given)
{
    EXACT float speed = float3_length(rate);
    EXACT float per_metre = exact_div(SPIN_PER_PUSH, answer.radius);
    EXACT float most = (answer.rolling * given) * per_metre;
    EXACT float taken = exact_min(most, speed);
    EXACT float quotient = exact_div(taken, speed);
    EXACT float against = -quotient;
    EXACT float3 y = float3_scale(rate, against);
    return y;
}

/* Returns how a ball that spins leaves a surface, from its velocities relative to the surface
 * before and after the bounce. Friction acts against the slip of the ball's surface. The collider
 * turns by `turning` rad/s; `ground` is its velocity at the ball's centre. */
FN_APART S(collide_state) collide_roll(S(collide_answer) answer, S(collide_state) s,
                                       float3 relative, float3 bounced, float3 normal,
                                       float3 ground, float3 turning)
{
    EXACT S(collide_state) after = s;
    EXACT float before = float3_dot(relative, normal);
    EXACT float now = float3_dot(bounced, normal);
    EXACT float gained = now - before;
    EXACT float given = exact_max(gained, 0.0f);
    EXACT float inwards = -answer.radius;
    EXACT float3 arm = float3_scale(normal, inwards);
    EXACT float3 rate = float3_sub(s.spin, turning);
    EXACT float3 around = float3_cross(rate, arm);
    EXACT float3 moving = float3_add(bounced, around);
    EXACT float across = -float3_dot(moving, normal);
    EXACT float3 slip = float3_add_scaled(moving, normal, across);
    EXACT float most = answer.grip * given;
    EXACT float3 change = spin_grip(slip, most);
    EXACT float3 spin_change = spin_from(change, normal, answer.radius);
    rate = float3_add(rate, spin_change);
    EXACT float3 slower = collide_rolling(answer, rate, given);
    rate = float3_add(rate, slower);
    EXACT float3 spin = float3_add(rate, turning);
    EXACT float3 left = float3_add(bounced, change);
    after.velocity = float3_add(ground, left);
    after.spin = spin_held(spin);
    return after;
}

/* Returns no rotation, for surfaces that do not turn, or whose velocity is known at the contact. */
FN float3 collide_not_turning(void)
{
    EXACT float3 y = FLOAT3(0.0f, 0.0f, 0.0f);
    return y;
}

/* Returns how a particle leaves a surface. */
FN S(collide_state) collide_leave(S(collide_answer) answer, S(collide_state) s, float3 relative,
                                  float3 bounced, float3 normal, float3 ground, float3 turning)
{
    EXACT S(collide_state) after = s;
    if (COLLIDE_SPINS(answer)) {
        after = collide_roll(answer, s, relative, bounced, normal, ground, turning);
        return after;
    }
    after.velocity = float3_add(ground, bounced);
    return after;
}

/* Returns how a particle leaves a surface that counts as resting (collide_clamp). */
FN S(collide_state) collide_stay(S(collide_answer) answer, S(collide_state) s, float3 bounced,
                                 float3 normal)
{
    EXACT S(collide_state) after = s;
    if (COLLIDE_SPINS(answer)) {
        EXACT float3 still = collide_not_turning();
        after = collide_roll(answer, s, s.velocity, bounced, normal, still, still);
        return after;
    }
    after.velocity = bounced;
    return after;
}

#endif
