/* Evaluates animated numbers. A number is a constant, or keys over a clock, joined by straight
 * lines and constant before the first and after the last key. All keys of a scene lie in one table,
 * so a value is 16 bytes.
 *
 * In GLSL the including shader declares the table `float4 value_keys[]` in a uniform block, since
 * many reads of one address of a storage buffer are slow on llvmpipe. A table that is too large for
 * that lies in a storage block. In C it is passed as a parameter. */
#ifndef KILN_SHARED_VALUE_H
#define KILN_SHARED_VALUE_H

#include "shared/limits.h"
#include "shared/platform.h"

/* The clocks that the x of a key may count. A constant has count 0. */
#define KILN_CLOCK_CONSTANT 0u
#define KILN_CLOCK_TIME     1u /* seconds; 0 is the first frame of the clip, warm-up is before it */
#define KILN_CLOCK_LIFE     2u /* 0 at birth, 1 at death */

struct kiln_value {
    float constant; /* value if the clock is KILN_CLOCK_CONSTANT */
    uint first;     /* index of the first key */
    uint count;     /* number of keys */
    uint clock;
};

struct kiln_value3 {
    S(kiln_value) x, y, z;
};

/* A number chosen at random for each particle, uniformly between two animated ends. */
struct kiln_range {
    S(kiln_value) min, max;
};

#define VALUE_MAX_KEYS 1024 /* keys of one value */

#ifdef GL_core_profile
#define VALUE_KEYS
#define VALUE_KEYS_PARAM
#else
#define VALUE_KEYS       value_keys,
#define VALUE_KEYS_PARAM const float4 *value_keys,
#endif

#ifndef VALUE_UNROLLED

/* Returns the index of the last key at or before x, or of the first. */
FN uint value_find(VALUE_KEYS_PARAM S(kiln_value) v, float x)
{
    uint k = v.first;
    uint end = v.first + v.count;
    while (end - k > 1u) {
        uint middle = k + (end - k) / 2u;
        bool before = value_keys[middle].x <= x;
        k = before ? middle : k;
        end = before ? end : middle;
    }
    return k;
}

#else /* GLSL, for compilers that take very long over many loops */

uint value_try(uint k, uint distance, uint last, float x)
{
    uint other = min(k + distance, last);
    return value_keys[other].x <= x ? other : k;
}

/* The distances add up to 1,023, and a value has at most VALUE_MAX_KEYS keys. */
uint value_find(kiln_value v, float x)
{
    uint last = v.first + v.count - 1u;
    uint k = value_try(v.first, 512u, last, x);
    k = value_try(k, 256u, last, x);
    k = value_try(k, 128u, last, x);
    k = value_try(k, 64u, last, x);
    k = value_try(k, 32u, last, x);
    k = value_try(k, 16u, last, x);
    k = value_try(k, 8u, last, x);
    k = value_try(k, 4u, last, x);
    k = value_try(k, 2u, last, x);
    k = value_try(k, 1u, last, x);
    return k;
}

#endif

/* Returns a value by its key, which is (x, y, slope to the next key, integral from 0 to x); the
 * host computes the last two. */
FN float value_at_key(VALUE_KEYS_PARAM S(kiln_value) v, float x)
{
    uint last = v.first + v.count - 1u;
    uint k = value_find(VALUE_KEYS v, x);
    EXACT float4 key = value_keys[k];
    if (x <= key.x || k == last)
        return key.y;
    EXACT float dx = x - key.x;
    EXACT float dy = dx * key.z;
    EXACT float y = key.y + dy;
    return y;
}

/* Returns the value at a time (seconds) and a progress of life (0 to 1); the value's clock decides
 * which counts. */
FN float value_at(VALUE_KEYS_PARAM S(kiln_value) v, float time_s, float life)
{
    if (v.count == 0u)
        return v.constant;
    EXACT float x = v.clock == KILN_CLOCK_LIFE ? life : time_s;
    return value_at_key(VALUE_KEYS v, x);
}

FN float3 value3_at(VALUE_KEYS_PARAM S(kiln_value3) v, float time_s, float life)
{
    EXACT float3 y =
        FLOAT3(value_at(VALUE_KEYS v.x, time_s, life), value_at(VALUE_KEYS v.y, time_s, life),
               value_at(VALUE_KEYS v.z, time_s, life));
    return y;
}

/* Returns the integral of a curve over life, or of a constant, from 0 to x >= 0. If no value is
 * negative, it never falls as x rises, also in floats. For a rising piece, the area from its left
 * end is a product of two factors that both grow. For a falling piece, the area to its right end is
 * a product of two factors that both shrink. */
FN float value_sum_at(VALUE_KEYS_PARAM S(kiln_value) v, float x)
{
    if (v.count == 0u) {
        EXACT float flat_sum = v.constant * x;
        return flat_sum;
    }
    uint last = v.first + v.count - 1u;
    uint k = value_find(VALUE_KEYS v, x);
    EXACT float4 key = value_keys[k];
    EXACT float dx = x - key.x;
    EXACT float before = key.y * x;
    EXACT float half_slope = key.z * 0.5f;
    EXACT float height = key.y + half_slope * dx;
    EXACT float sum = key.w + height * dx;
    if (dx < 0.0f)
        return before;
    if (k == last)
        return sum;
    EXACT float4 next = value_keys[k + 1u];
    EXACT float left = next.x - x;
    EXACT float height_left = next.y - half_slope * left;
    EXACT float falling = next.w - height_left * left;
    sum = key.z < 0.0f ? falling : sum;
    sum = sum < key.w ? key.w : sum;
    sum = sum > next.w ? next.w : sum;
    return sum;
}

/* Returns how fast a value over time changes, per second: 0 before the first and from the last key
 * on. */
FN float value_rate_at(VALUE_KEYS_PARAM S(kiln_value) v, float time_s)
{
    if (v.count == 0u || v.clock != KILN_CLOCK_TIME)
        return 0.0f;
    uint last = v.first + v.count - 1u;
    uint k = value_find(VALUE_KEYS v, time_s);
    EXACT float4 key = value_keys[k];
    if (time_s < key.x || k == last)
        return 0.0f;
    return key.z;
}

#endif
