/* Computes the noise that values may vary by: value noise over the time. At every whole number x it
 * has a random number from 0 to 1, and between two of them it goes from one to the other without a
 * kink in its speed (Perlin, "Improving Noise", 2002: the same polynomial). Further octaves are
 * twice as fast and half as strong. */
#ifndef KILN_SHARED_VALUE_NOISE_H
#define KILN_SHARED_VALUE_NOISE_H

#include "shared/random.h"

#define VALUE_NOISE_OCTAVES 8u /* the most */

struct value_noise {
    uint seed;
    uint octaves;
    float x; /* time in periods */
};

/* A place between two random numbers. */
struct value_noise_place {
    float left, right; /* the random numbers */
    float part;        /* of the way, 0 to 1 */
};

FN S(value_noise_place) value_noise_find(uint seed, float x)
{
    EXACT float held = exact_clamp(x, -1073741824.0f, 1073741824.0f);
    EXACT float whole = FLOOR(held);
    uint number = UINT(INT(whole));
    EXACT S(value_noise_place) place;
    place.part = held - whole;
    place.left = random_to_unit(random_mix(seed + number * 0x9e3779b9u));
    place.right = random_to_unit(random_mix(seed + (number + 1u) * 0x9e3779b9u));
    return place;
}

/* Returns one octave, 0 to 1. */
FN float value_noise_octave(uint seed, float x)
{
    EXACT S(value_noise_place) p = value_noise_find(seed, x);
    EXACT float cubed = p.part * p.part * p.part;
    EXACT float way = cubed * (p.part * (p.part * 6.0f - 15.0f) + 10.0f);
    return exact_lerp(p.left, p.right, way);
}

/* Returns how fast an octave changes with x. */
FN float value_noise_octave_rate(uint seed, float x)
{
    EXACT S(value_noise_place) p = value_noise_find(seed, x);
    EXACT float left = 1.0f - p.part;
    EXACT float both = p.part * left;
    EXACT float rise = 30.0f * (both * both);
    EXACT float y = (p.right - p.left) * rise;
    return y;
}

/* Returns the seed of an octave. */
FN uint value_noise_seed(uint seed, uint octave)
{
    return random_mix(seed + octave * 0x85ebca6bu);
}

/* Returns the noise, 0 to 1. */
FN float value_noise_at(S(value_noise) noise)
{
    EXACT float sum = 0.0f;
    EXACT float all = 0.0f;
    EXACT float strength = 1.0f;
    EXACT float x = noise.x;
    for (uint octave = 0u; octave < noise.octaves; octave++) {
        sum = sum + strength * value_noise_octave(value_noise_seed(noise.seed, octave), x);
        all = all + strength;
        strength = strength * 0.5f;
        x = x * 2.0f;
    }
    EXACT float mean = exact_div(sum, all);
    EXACT float y = exact_clamp(mean, 0.0f, 1.0f);
    return y;
}

/* Returns how fast the noise changes with x. */
FN float value_noise_rate(S(value_noise) noise)
{
    EXACT float sum = 0.0f;
    EXACT float all = 0.0f;
    EXACT float strength = 1.0f;
    EXACT float x = noise.x;
    for (uint octave = 0u; octave < noise.octaves; octave++) {
        /* an octave's strength and its speed cancel */
        sum = sum + value_noise_octave_rate(value_noise_seed(noise.seed, octave), x);
        all = all + strength;
        strength = strength * 0.5f;
        x = x * 2.0f;
    }
    EXACT float y = exact_div(sum, all);
    return y;
}

#endif
