/* Computes how balls turn (UberFlow 2004, 4.5). Friction acts where a ball touches another or a
 * surface, and takes at most the slip there. A solid ball of mass m that loses its slip gains 2/7
 * of it as velocity, because a push at its skin also turns it (its moment of inertia is 2/5 m r^2).
 * The kernel that computes pushes writes the rates after contacts with other balls; the step writes
 * the rates after contacts with surfaces, and the poses (struct kiln_spin). */
#ifndef KILN_SHARED_SPIN_H
#define KILN_SHARED_SPIN_H

#include "shared/particle.h"
#include "shared/random.h"

/* Factors of solid balls: 5/2 and 2/7. */
#define SPIN_PER_PUSH 2.5f
#define SPIN_OF_SLIP  0.285714298f

/* rad/s: limit of spins. A ball that would spin faster is held at it. */
#define SPIN_FASTEST 1048576.0f

FN uint4 spin_words_of(float3 v)
{
    EXACT float3 c = float3_canon(v);
    return UINT4(FLOAT_BITS(c.x), FLOAT_BITS(c.y), FLOAT_BITS(c.z), 0u);
}

/* Limits one component of a spin; NaN becomes 0. */
FN float spin_held_along(float rate)
{
    EXACT float number = (FLOAT_BITS(rate) & EXACT_SIZE_BITS) > 0x7f800000u ? 0.0f : rate;
    EXACT float y = exact_clamp(number, -SPIN_FASTEST, SPIN_FASTEST);
    return y;
}

FN float3 spin_held(float3 rate)
{
    EXACT float3 y =
        FLOAT3(spin_held_along(rate.x), spin_held_along(rate.y), spin_held_along(rate.z));
    return y;
}

FN float3 spin_rate(uint4 bits)
{
    EXACT float3 v = FLOAT3(BITS_FLOAT(bits.x), BITS_FLOAT(bits.y), BITS_FLOAT(bits.z));
    EXACT float3 y = spin_held(v);
    return y;
}

/* Returns the change of velocity across a contact by friction: 2/7 of the slip, which stops it, but
 * at most `most` m/s. */
FN float3 spin_grip(float3 slip, float most)
{
    EXACT float speed = float3_length(slip);
    EXACT float wanted = speed * SPIN_OF_SLIP;
    EXACT float taken = exact_min(wanted, most);
    EXACT float quotient = exact_div(taken, speed);
    EXACT float against = -quotient;
    EXACT float3 y = float3_scale(slip, against);
    return y;
}

/* Returns the spin, rad/s, that a ball gets from a change of velocity by friction. `normal` points
 * away from the surface or from the other ball that touches it. */
FN float3 spin_from(float3 change, float3 normal, float radius)
{
    EXACT float3 across = float3_cross(change, normal);
    EXACT float per_metre = exact_div(SPIN_PER_PUSH, radius);
    EXACT float3 y = float3_scale(across, per_metre);
    return y;
}

/* ---- poses ---------------------------------------------------------------------------------- */

FN float4 spin_pose(uint4 bits)
{
    EXACT float4 q =
        FLOAT4(BITS_FLOAT(bits.x), BITS_FLOAT(bits.y), BITS_FLOAT(bits.z), BITS_FLOAT(bits.w));
    return q;
}

/* Normalises a pose; a zero pose becomes one without rotation. */
FN float4 spin_unit(float4 q)
{
    EXACT float square = (q.x * q.x + q.y * q.y) + (q.z * q.z + q.w * q.w);
    EXACT float r = exact_rsqrt(square);
    EXACT float4 y = FLOAT4(q.x * r, q.y * r, q.z * r, q.w * r);
    if (r == 0.0f)
        y = FLOAT4(0.0f, 0.0f, 0.0f, 1.0f);
    return y;
}

/* Returns a pose after turning at a rate, rad/s, for a time. */
FN float4 spin_integrate(float4 p, float3 rate, float time_s)
{
    EXACT float speed = float3_length(rate);
    EXACT float half_angle = (0.5f * time_s) * speed;
    EXACT S(exact_angle) turn = exact_sincos(half_angle);
    EXACT float along = exact_div(turn.sine, speed);
    EXACT float w = turn.cosine;
    EXACT float x = rate.x * along;
    EXACT float y = rate.y * along;
    EXACT float z = rate.z * along;
    EXACT float4 q = FLOAT4(
        (w * p.x + x * p.w) + (y * p.z - z * p.y), (w * p.y + y * p.w) + (z * p.x - x * p.z),
        (w * p.z + z * p.w) + (x * p.y - y * p.x), (w * p.w - x * p.x) - (y * p.y + z * p.z));
    EXACT float4 unit = spin_unit(q);
    return unit;
}

/* Returns the pose of a rotation about a unit vector. */
FN float4 spin_about(float3 axis, float angle)
{
    EXACT float half_angle = 0.5f * angle;
    EXACT S(exact_angle) turn = exact_sincos(half_angle);
    EXACT float4 q =
        FLOAT4(axis.x * turn.sine, axis.y * turn.sine, axis.z * turn.sine, turn.cosine);
    return q;
}

FN uint4 spin_pose_words(float4 q)
{
    return UINT4(FLOAT_BITS(exact_canon(q.x)), FLOAT_BITS(exact_canon(q.y)),
                 FLOAT_BITS(exact_canon(q.z)), FLOAT_BITS(exact_canon(q.w)));
}

/* Returns a random pose, all being equally likely (Shoemake, "Uniform Random Rotations", 1992). */
FN float4 spin_any_pose(uint stream)
{
    EXACT float part = random_unit(stream, RANDOM_POSE);
    EXACT float rest = 1.0f - part;
    EXACT float angle = random_unit(stream, RANDOM_POSE + 1u) * EXACT_TWO_PI;
    EXACT float other = random_unit(stream, RANDOM_POSE + 2u) * EXACT_TWO_PI;
    EXACT S(exact_angle) first = exact_sincos(angle);
    EXACT S(exact_angle) second = exact_sincos(other);
    EXACT float a = exact_sqrt(rest);
    EXACT float b = exact_sqrt(part);
    EXACT float4 q = FLOAT4(a * first.sine, a * first.cosine, b * second.sine, b * second.cosine);
    EXACT float4 unit = spin_unit(q);
    return unit;
}

/* Returns the spin at birth, rad/s, about `axis`, or about a random axis for each particle where
 * `axis` is zero. */
FN float3 spin_at_birth(uint stream, float low, float high, float3 axis)
{
    EXACT float speed = random_between(stream, RANDOM_WHIRL, low, high);
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 any = random_direction(stream, RANDOM_WHIRL + 1u, up, -1.0f);
    EXACT float3 about = float3_normalize(axis, any);
    EXACT float3 y = float3_scale(about, speed);
    return y;
}

#endif
