/* What an impact makes of a velocity (Heinz 2019, 3.5): mirrored, astray, slowed, rubbed. */
#ifndef KILN_SHARED_COLLIDE_BOUNCE_H
#define KILN_SHARED_COLLIDE_BOUNCE_H

#include "shared/collide_box.h"
#include "shared/random.h"

/* Shaders of scenes without restitution and friction are spared them. */
#if defined(GL_core_profile) && !defined(COLLIDE_RUB)
#define COLLIDE_RUBS(answer) false
#else
#define COLLIDE_RUBS(answer) ((answer).rubs)
#endif

/* How a particle answers an impact. */
struct collide_answer {
    float randomness; /* 0 mirror .. 1 any direction of the hemisphere */
    float slowdown;   /* factor on the speed */
    uint stream;      /* the particle's */
    uint purpose;     /* of two numbers for this impact */
    bool rubs;        /* whether the rest matters */
    float restitution;
    float friction;
    float radius; /* m: how near its centre comes */
};

/* On a collider with factors of its own. */
FN S(collide_answer) collide_answer_of(S(collide_answer) answer, S(kiln_collider) c)
{
    EXACT S(collide_answer) y = answer;
    if (COLLIDE_RUBS(answer)) {
        y.restitution = answer.restitution * c.restitution;
        y.friction = answer.friction * c.friction;
    }
    return y;
}

/* What restitution leaves of a mirrored velocity along the normal, and Coulomb's friction of the
 * rest: it takes as much as its factor on what the surface gives along the normal, but turns
 * nothing around. */
FN_APART float3 collide_rubbed(float restitution, float friction, float3 mirrored, float3 normal,
                               float outwards)
{
    EXACT float inwards = -outwards;
    EXACT float3 aside = float3_add_scaled(mirrored, normal, inwards);
    EXACT float speed = float3_length(aside);
    EXACT float given = outwards * (1.0f + restitution);
    EXACT float slower = speed - friction * given;
    EXACT float quotient = exact_div(slower, speed);
    EXACT float kept = exact_clamp(quotient, 0.0f, 1.0f);
    EXACT float returned = outwards * restitution;
    EXACT float3 along = float3_scale(normal, returned);
    EXACT float3 y = float3_add_scaled(along, aside, kept);
    return y;
}

/* The velocity (relative to the box) after an impact: a linear combination of the mirrored and a
 * random direction, with the slowed speed. The random direction is of the hemisphere about the
 * face's normal, so that it never points inwards; with `literal`, about the mirrored direction. */
FN float3 collide_bounce(S(collide_answer) answer, float3 velocity, uint face, bool literal)
{
    uint axis = face >> 1u;
    EXACT float out_sign = (face & 1u) != 0u ? 1.0f : -1.0f;
    EXACT float across = collide_component(velocity, axis);
    EXACT float outwards = across * out_sign;
    if (outwards >= 0.0f)
        return velocity;
    EXACT float3 mirrored = collide_with_component(velocity, axis, -across);
    EXACT float square = float3_dot(velocity, velocity);
    EXACT float3 zero = FLOAT3(0.0f, 0.0f, 0.0f);
    EXACT float3 normal = collide_with_component(zero, axis, out_sign);
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
    EXACT float kept = 1.0f - answer.randomness;
    EXACT float3 part = float3_scale(straight, kept);
    EXACT float3 mixed = float3_add_scaled(part, astray, answer.randomness);
    EXACT float3 direction = float3_normalize(mixed, straight);
    EXACT float slowed = speed * answer.slowdown;
    EXACT float3 y = float3_scale(direction, slowed);
    return y;
}

/* The same for a surface of any direction. */
FN_CLOSE float3 collide_bounce_off(S(collide_answer) answer, float3 velocity, float3 normal,
                                   bool literal)
{
    EXACT float outwards = float3_dot(velocity, normal);
    if (outwards >= 0.0f)
        return velocity;
    EXACT float twice = -2.0f * outwards;
    EXACT float3 mirrored = float3_add_scaled(velocity, normal, twice);
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
    EXACT float kept = 1.0f - answer.randomness;
    EXACT float3 part = float3_scale(straight, kept);
    EXACT float3 mixed = float3_add_scaled(part, astray, answer.randomness);
    EXACT float3 direction = float3_normalize(mixed, straight);
    EXACT float slowed = speed * answer.slowdown;
    EXACT float3 y = float3_scale(direction, slowed);
    return y;
}

#endif
