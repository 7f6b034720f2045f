/* Makes random numbers without state (docs/determinism.md, 2). A number is a hash of (seed, system,
 * serial, purpose), so that any stage can draw a particle's numbers again. */
#ifndef KILN_SHARED_RANDOM_H
#define KILN_SHARED_RANDOM_H

#include "shared/exact.h"

/* Purposes of numbers. A purpose that takes several numbers owns the following ones, too. */
#define RANDOM_LIFE      0u
#define RANDOM_SPEED     1u
#define RANDOM_DIRECTION 2u /* 2 numbers */
#define RANDOM_PLACE     4u /* 5 numbers */
#define RANDOM_SCALE     9u
#define RANDOM_ROTATION  10u
#define RANDOM_SPIN      11u /* 2 numbers: rate and sign */
#define RANDOM_CELL      13u
#define RANDOM_TEXTURE   14u
#define RANDOM_AXIS      15u /* 2 numbers */
#define RANDOM_PAINT     20u
#define RANDOM_POSE      24u         /* 3 numbers */
#define RANDOM_WHIRL     27u         /* 3 numbers: rate and direction */
#define RANDOM_VALUES    0x20000000u /* + VALUE_DRAW (value.h): random values and their noise */
#define RANDOM_BOUNCE    0x40000000u /* + step << 4 + bounce << 1: 2 numbers */
#define RANDOM_CHANCE    0x50000000u /* + step: whether an impact ends a particle, or stops it */
#define RANDOM_CHILDREN  0x58000000u /* + event: number of the children of a parent */
#define RANDOM_BURST     0x60000000u /* + repetition << 1: 2 numbers, count and delay */

/* Hashes 32 bits so that half of the bits change when one changes (a finaliser with the constants
 * of C. Wellons' search, bias 0.1). */
FN uint random_mix(uint x)
{
    x ^= x >> 16u;
    x *= 0x21f0aaadu;
    x ^= x >> 15u;
    x *= 0xd35a2d97u;
    x ^= x >> 15u;
    return x;
}

/* The number among those of the systems that belongs to the noise that all systems share. States
 * depend on it, so it must not change. */
#define RANDOM_NOISE_NUMBER 16u

/* Returns the key of a number in a run. */
FN uint random_key(uint seed, uint number)
{
    return random_mix(random_mix(seed) + number * 0x9e3779b9u);
}

/* Returns the key of a system of particles. */
FN uint random_system_key(uint seed, uint system)
{
    return random_key(seed, system < RANDOM_NOISE_NUMBER ? system : system + 1u);
}

/* Returns the key of the noise that all systems share. */
FN uint random_noise_key(uint seed)
{
    return random_key(seed, RANDOM_NOISE_NUMBER);
}

/* Returns the key of a domain of gas. */
FN uint random_gas_key(uint seed, uint domain)
{
    return random_key(seed ^ 0x67617300u, domain);
}

/* Returns the stream of a particle; no two particles of a system share one. */
FN uint random_stream(uint key, uint serial)
{
    return random_mix(serial + key);
}

FN uint random_bits(uint stream, uint purpose)
{
    return random_mix(stream ^ random_mix(purpose + 0x9e3779b9u));
}

/* Maps bits to [0, 1), a multiple of 2^-24. Processors convert signed numbers faster. */
FN float random_to_unit(uint bits)
{
    EXACT float y = FLOAT(INT(bits >> 8u)) * 5.9604644775390625e-8f;
    return y;
}

FN float random_unit(uint stream, uint purpose)
{
    EXACT float y = random_to_unit(random_bits(stream, purpose));
    return y;
}

/* Returns a number in [low, high]. */
FN float random_between(uint stream, uint purpose, float low, float high)
{
    EXACT float u = random_unit(stream, purpose);
    EXACT float y = exact_lerp(low, high, u);
    return y;
}

/* Two unit vectors that form a right-handed frame with the unit vector w. */
struct random_frame {
    float3 u, v;
};

/* Computes the frame of Duff et al., "Building an Orthonormal Basis, Revisited" (2017). It has no
 * branch except for a sign, and fails nowhere. */
FN S(random_frame) random_frame_about(float3 w)
{
    EXACT float side = w.z >= 0.0f ? 1.0f : -1.0f;
    EXACT float sum = side + w.z;
    EXACT float a = -exact_rcp(sum);
    EXACT float b = w.x * w.y * a;
    EXACT S(random_frame) frame;
    frame.u = FLOAT3(1.0f + side * (w.x * w.x * a), side * b, -side * w.x);
    frame.v = FLOAT3(b, side + w.y * w.y * a, -w.y);
    return frame;
}

/* Returns a direction that is uniform on a part of the unit sphere: within the angle of `axis`
 * (unit length) whose cosine is given; -1 is the whole sphere. Takes numbers purpose and purpose +
 * 1. The angle grows with the first: its cosine is 1 - u (1 - cos_angle). */
FN float3 random_direction(uint stream, uint purpose, float3 axis, float cos_angle)
{
    EXACT float u = random_unit(stream, purpose);
    EXACT float turn = random_unit(stream, purpose + 1u);
    EXACT float depth = u * (1.0f - cos_angle); /* 1 - cosine of the angle */
    EXACT float square = depth * (2.0f - depth);
    EXACT float radius = exact_sqrt(square);
    EXACT float angle = turn * EXACT_TWO_PI;
    EXACT S(exact_angle) around = exact_sincos(angle);
    EXACT S(random_frame) frame = random_frame_about(axis);
    EXACT float along = 1.0f - depth;
    EXACT float sideways = radius * around.cosine;
    EXACT float upwards = radius * around.sine;
    EXACT float3 y = float3_scale(axis, along);
    y = float3_add_scaled(y, frame.u, sideways);
    y = float3_add_scaled(y, frame.v, upwards);
    return y;
}

/* Returns a point that is uniform in the unit ball, or on its surface. Takes 5 numbers: the largest
 * of three is distributed like the radius, which saves a cube root. */
FN float3 random_in_ball(uint stream, uint purpose, bool surface)
{
    EXACT float a = random_unit(stream, purpose + 2u);
    EXACT float b = random_unit(stream, purpose + 3u);
    EXACT float c = random_unit(stream, purpose + 4u);
    EXACT float larger = exact_max(b, c);
    EXACT float largest = exact_max(a, larger);
    EXACT float radius = surface ? 1.0f : largest;
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 direction = random_direction(stream, purpose, up, -1.0f);
    EXACT float3 y = float3_scale(direction, radius);
    return y;
}

#endif
