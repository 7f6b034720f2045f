/* Evaluates values: numbers that are constants, or curves over a clock. A curve has keys, which are
 * joined by lines, and is constant before the first and after the last key. The clock says what the
 * x of the keys counts: the time, a particle's life, its speed, or a random number that it draws
 * once. All keys of a scene lie in one table, so a value is 16 bytes.
 *
 * In GLSL the including shader declares the table `float4 value_keys[]` in a uniform block, since
 * many reads of one address of a storage buffer are slow on llvmpipe. A table that is too large for
 * that lies in a storage block. In C it is passed as a parameter. */
#ifndef KILN_SHARED_VALUE_H
#define KILN_SHARED_VALUE_H

#include "shared/limits.h"
#include "shared/value_noise.h"

/* The clocks. A constant has count 0. */
#define KILN_CLOCK_CONSTANT 0u
#define KILN_CLOCK_TIME     1u /* seconds; 0 is the first frame of the clip, warm-up is before it */
#define KILN_CLOCK_LIFE     2u /* 0 at birth, 1 at death */
#define KILN_CLOCK_AGE      3u /* seconds since birth */
#define KILN_CLOCK_SPEED    4u /* m/s */
#define KILN_CLOCK_HEIGHT   5u /* m: y in the world */
#define KILN_CLOCK_DISTANCE 6u /* m to the eye; when a particle is drawn */
#define KILN_CLOCK_RANDOM   7u /* 0 to 1: a number that each particle draws once */
#define KILN_CLOCK_NOISE    8u /* 0 to 1: a smooth noise over time */

/* The parts of the word `how`. */
#define VALUE_CLOCK(how)   ((how)&15u)
#define VALUE_EASE(how)    ((how) >> 4u & 7u)
#define VALUE_REPEAT(how)  ((how) >> 7u & 3u)
#define VALUE_DRAW(how)    ((how) >> 12u) /* the number of the draw, of random numbers and noise */
#define VALUE_EASE_SHIFT   4u
#define VALUE_REPEAT_SHIFT 7u
#define VALUE_TIMES        0x200u /* the value is multiplied by another one */
#define VALUE_PLUS         0x400u /* another value is added */
#define VALUE_OF_PARTICLE                                                                          \
    0x800u /* each particle has a noise of its own, instead of each system                         \
            */
#define VALUE_DRAW_SHIFT 12u
#define VALUE_DRAW_BITS  20u
/* Returns whether the file gives the number of the draw. */
#define VALUE_IS_SEEDED(how) (((how) >> 31u) != 0u)

/* How a value goes from a key to the next. A curve of steps has slopes of 0. */
#define VALUE_LINEAR 0u
#define VALUE_STEP   1u
#define VALUE_SMOOTH 2u /* 3 t^2 - 2 t^3; this one and those below have keys of their own form */
#define VALUE_IN     3u /* t^2 */
#define VALUE_OUT    4u /* 2 t - t^2 */

/* What a value does before its first and after its last key. */
#define VALUE_HOLDS   0u
#define VALUE_LOOPS   1u
#define VALUE_MIRRORS 2u /* goes back and forth */

struct kiln_value {
    float constant; /* value if count is 0 */
    uint first;     /* index of the first key */
    uint count;     /* number of keys */
    uint how;       /* clock, ease and so on */
};

struct kiln_value3 {
    S(kiln_value) x, y, z;
};

/* A number chosen at random for each particle, uniformly between two animated ends. */
struct kiln_range {
    S(kiln_value) min, max;
};

/* A value is plain if its keys and a clock are all of it. One that is not has entries in the table
 * of keys right before its first key:
 *
 *    first - 1  its least and its greatest result; of noise, its period in seconds, and octaves
 *    first - 2  the value that multiplies it, packed as value_unpack reads it
 *    first - 3  the value that is added to it
 *
 * An entry exists if it, or one before it in this list, is needed. */
#define VALUE_NOT_PLAIN(how)                                                                       \
    (((how) & (VALUE_TIMES | VALUE_PLUS)) != 0u || VALUE_EASE(how) >= VALUE_SMOOTH ||              \
     VALUE_REPEAT(how) != VALUE_HOLDS || VALUE_CLOCK(how) == KILN_CLOCK_NOISE)
#define VALUE_ENTRIES 3u

#define VALUE_MAX_KEYS 1024 /* keys of one value */

/* What the clocks show, of one particle or of none. */
struct value_clocks {
    float time_s;
    float life;
    float age_s;
    float height;                    /* m */
    float distance;                  /* m */
    float3 velocity;                 /* m/s */
    uint stream;                     /* the particle's random numbers */
    float parent_life, parent_age_s; /* its parent's, when it was born */
    uint parent_stream;
    uint system; /* the system's random numbers, or the scene's */
    uint scene;  /* the scene's, which a noise of a system has if the file gives it a seed */
};

/* A kernel of GLSL may have a mask of the clocks of its values (lib/sim/step/uses.c): bits by the
 * number of the clock, and those below. Compilers leave out what is not in it. */
#define VALUE_USES_EASE   16u /* VALUE_SMOOTH and what follows it */
#define VALUE_USES_REPEAT 17u
#define VALUE_USES_PARTS  18u /* VALUE_TIMES, VALUE_PLUS, and limits of results */

#ifdef GL_core_profile
#define VALUE_KEYS
#define VALUE_KEYS_PARAM
#ifndef USES_CLOCKS
#define USES_CLOCKS 0xffffffffu
#endif
#define VALUE_USES(part) (((USES_CLOCKS >> (part)) & 1u) != 0u)
#else
#define VALUE_KEYS       value_keys,
#define VALUE_KEYS_PARAM const float4 *value_keys,
#define VALUE_USES(part) true
#endif

/* Returns the clocks of a moment at which there is no particle. */
FN S(value_clocks) value_clocks_at(float time_s, uint system, uint scene)
{
    EXACT S(value_clocks) clocks;
    clocks.time_s = time_s;
    clocks.life = 0.0f;
    clocks.age_s = 0.0f;
    clocks.height = 0.0f;
    clocks.distance = 0.0f;
    clocks.velocity = FLOAT3(0.0f, 0.0f, 0.0f);
    clocks.stream = 0u;
    clocks.parent_life = 0.0f;
    clocks.parent_age_s = 0.0f;
    clocks.parent_stream = 0u;
    clocks.system = system;
    clocks.scene = scene;
    return clocks;
}

/* Returns the clocks of a particle's birth. */
FN S(value_clocks) value_clocks_of_birth(float time_s, uint system, uint scene, uint stream)
{
    EXACT S(value_clocks) clocks = value_clocks_at(time_s, system, scene);
    clocks.stream = stream;
    return clocks;
}

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

/* Returns how far a value has gone from one key to the next, after the part t of the way. */
FN float value_eased(uint ease, float t)
{
    EXACT float square = t * t;
    EXACT float twice = 2.0f * t;
    EXACT float smooth_way = square * (3.0f - twice);
    EXACT float out_way = twice - square;
    EXACT float y = ease == VALUE_SMOOTH ? smooth_way : ease == VALUE_IN ? square : out_way;
    return y;
}

/* Returns a value whose keys are (x, y, difference to the next key, 1 / distance to it). */
FN float value_eased_at_key(VALUE_KEYS_PARAM S(kiln_value) v, float x)
{
    uint last = v.first + v.count - 1u;
    uint k = value_find(VALUE_KEYS v, x);
    EXACT float4 key = value_keys[k];
    if (x <= key.x || k == last)
        return key.y;
    EXACT float t = (x - key.x) * key.w;
    EXACT float inside = exact_min(t, 1.0f);
    EXACT float way = value_eased(VALUE_EASE(v.how), inside);
    EXACT float dy = way * key.z;
    EXACT float y = key.y + dy;
    EXACT float next_y = value_keys[k + 1u].y;
    EXACT float low = exact_min(key.y, next_y);
    EXACT float high = exact_max(key.y, next_y);
    EXACT float within = exact_clamp(y, low, high);
    return within;
}

/* A place among the keys of a value that repeats. */
struct value_turn {
    float x;
    bool back; /* the value runs from its last key to its first */
};

FN S(value_turn) value_repeated(VALUE_KEYS_PARAM S(kiln_value) v, float x)
{
    EXACT float from = value_keys[v.first].x;
    EXACT float to = value_keys[v.first + v.count - 1u].x;
    EXACT float length = to - from;
    EXACT float since = x - from;
    EXACT float turns = FLOOR(exact_div(since, length));
    EXACT float whole = turns * length;
    EXACT float rest = since - whole;
    rest = exact_clamp(rest, 0.0f, length);
    EXACT float pairs = FLOOR(turns * 0.5f);
    EXACT float odd = turns - 2.0f * pairs;
    EXACT S(value_turn) turn;
    turn.back = VALUE_REPEAT(v.how) == VALUE_MIRRORS && odd != 0.0f;
    EXACT float left = length - rest;
    rest = turn.back ? left : rest;
    turn.x = from + rest;
    return turn;
}

/* Returns the numbers of a value's noise. */
FN S(value_noise) value_noise_of(VALUE_KEYS_PARAM S(kiln_value) v, S(value_clocks) c)
{
    EXACT float4 entry = value_keys[v.first - 1u];
    EXACT S(value_noise) noise;
    uint draw = RANDOM_VALUES + VALUE_DRAW(v.how);
    uint of_system = VALUE_IS_SEEDED(v.how) ? c.scene : c.system;
    noise.seed = random_bits((v.how & VALUE_OF_PARTICLE) != 0u ? c.stream : of_system, draw);
    noise.octaves = UINT(entry.w);
    noise.x = exact_div(c.time_s, entry.z);
    return noise;
}

/* Returns what a value's clock shows. */
FN float value_clock(VALUE_KEYS_PARAM S(kiln_value) v, S(value_clocks) c)
{
    uint clock = VALUE_CLOCK(v.how);
    EXACT float x = clock == KILN_CLOCK_LIFE ? c.life : c.time_s;
    if (VALUE_USES(KILN_CLOCK_AGE) && clock == KILN_CLOCK_AGE)
        x = c.age_s;
    if (VALUE_USES(KILN_CLOCK_SPEED) && clock == KILN_CLOCK_SPEED)
        x = float3_length(c.velocity);
    if (VALUE_USES(KILN_CLOCK_HEIGHT) && clock == KILN_CLOCK_HEIGHT)
        x = c.height;
    if (VALUE_USES(KILN_CLOCK_DISTANCE) && clock == KILN_CLOCK_DISTANCE)
        x = c.distance;
    if (VALUE_USES(KILN_CLOCK_RANDOM) && clock == KILN_CLOCK_RANDOM)
        x = random_unit(c.stream, RANDOM_VALUES + VALUE_DRAW(v.how));
    if (VALUE_USES(KILN_CLOCK_NOISE) && clock == KILN_CLOCK_NOISE)
        x = value_noise_at(value_noise_of(VALUE_KEYS v, c));
    return x;
}

/* Returns a curve at x, without what multiplies it and what is added to it. */
FN float value_curve_at(VALUE_KEYS_PARAM S(kiln_value) v, float x)
{
    EXACT float at = x;
    if (VALUE_USES(VALUE_USES_REPEAT) && VALUE_REPEAT(v.how) != VALUE_HOLDS) {
        EXACT S(value_turn) turn = value_repeated(VALUE_KEYS v, x);
        at = turn.x;
    }
    if (VALUE_USES(VALUE_USES_EASE) && VALUE_EASE(v.how) >= VALUE_SMOOTH)
        return value_eased_at_key(VALUE_KEYS v, at);
    return value_at_key(VALUE_KEYS v, at);
}

/* Returns a value that an entry of the table packs: its constant, its first key, the count of its
 * keys plus 2,048 times the lower bits of `how`, and its draw. All are whole numbers that a float
 * has, since an entry must not hold bits that are no number. */
FN S(kiln_value) value_unpack(float4 entry)
{
    uint counted = UINT(entry.z);
    S(kiln_value) v;
    v.constant = entry.x;
    v.first = UINT(entry.y);
    v.count = counted & 2047u;
    v.how = counted >> 11u | UINT(entry.w) << VALUE_DRAW_SHIFT;
    return v;
}

/* Returns part 0 of a value, which is its own curve, or part 1 or 2: what multiplies it and what is
 * added to it. */
FN S(kiln_value) value_part(VALUE_KEYS_PARAM S(kiln_value) v, uint part)
{
    if (part == 0u)
        return v;
    return value_unpack(value_keys[v.first - 1u - part]);
}

/* Returns the result of a value within its limits. */
FN float value_limited(VALUE_KEYS_PARAM S(kiln_value) v, float result)
{
    EXACT float4 entry = value_keys[v.first - 1u];
    EXACT float y = exact_clamp(result, entry.x, entry.y);
    return y;
}

/* Returns a value that is not plain. */
FN_APART float value_of_keys(VALUE_KEYS_PARAM S(kiln_value) v, S(value_clocks) c)
{
    EXACT float result = 0.0f;
    for (uint part = 0u; part < VALUE_ENTRIES; part++) {
        bool has = part == 0u || (v.how & (part == 1u ? VALUE_TIMES : VALUE_PLUS)) != 0u;
        if (!has)
            continue;
        S(kiln_value) one = value_part(VALUE_KEYS v, part);
        EXACT float y = one.constant;
        if (one.count != 0u)
            y = value_curve_at(VALUE_KEYS one, value_clock(VALUE_KEYS one, c));
        EXACT float product = result * y;
        EXACT float sum = result + y;
        result = part == 1u ? product : sum;
    }
    return value_limited(VALUE_KEYS v, result);
}

/* Returns a value as its clock shows. */
FN float value_at(VALUE_KEYS_PARAM S(kiln_value) v, S(value_clocks) c)
{
    if (v.count == 0u)
        return v.constant;
    if (VALUE_USES(VALUE_USES_PARTS) && VALUE_NOT_PLAIN(v.how))
        return value_of_keys(VALUE_KEYS v, c);
    EXACT float x = value_clock(VALUE_KEYS v, c);
    return value_at_key(VALUE_KEYS v, x);
}

FN float3 value3_at(VALUE_KEYS_PARAM S(kiln_value3) v, S(value_clocks) c)
{
    EXACT float3 y = FLOAT3(value_at(VALUE_KEYS v.x, c), value_at(VALUE_KEYS v.y, c),
                            value_at(VALUE_KEYS v.z, c));
    return y;
}

/* Returns how fast a value's curve rises with x. */
FN float value_slope_at(VALUE_KEYS_PARAM S(kiln_value) v, float x)
{
    EXACT S(value_turn) turn;
    turn.x = x;
    turn.back = false;
    if (VALUE_USES(VALUE_USES_REPEAT) && VALUE_REPEAT(v.how) != VALUE_HOLDS)
        turn = value_repeated(VALUE_KEYS v, x);
    uint last = v.first + v.count - 1u;
    uint k = value_find(VALUE_KEYS v, turn.x);
    EXACT float4 key = value_keys[k];
    if (turn.x < key.x || k == last)
        return 0.0f;
    EXACT float slope = key.z;
    uint ease = VALUE_EASE(v.how);
    if (VALUE_USES(VALUE_USES_EASE) && ease >= VALUE_SMOOTH) {
        EXACT float t = (turn.x - key.x) * key.w;
        EXACT float rise = 2.0f * t;
        EXACT float left = 1.0f - t;
        EXACT float smooth_rise = 3.0f * rise * left;
        EXACT float out_rise = 2.0f * left;
        EXACT float rising = ease == VALUE_SMOOTH ? smooth_rise
                             : ease == VALUE_IN   ? rise
                                                  : out_rise;
        slope = slope * key.w * rising;
    }
    EXACT float back = -slope;
    return turn.back ? back : slope;
}

/* Returns how fast a value's own curve changes with the time, per second. */
FN float value_curve_rate_at(VALUE_KEYS_PARAM S(kiln_value) v, S(value_clocks) c)
{
    uint clock = VALUE_CLOCK(v.how);
    if (VALUE_USES(KILN_CLOCK_NOISE) && clock == KILN_CLOCK_NOISE) {
        EXACT S(value_noise) noise = value_noise_of(VALUE_KEYS v, c);
        EXACT float slope = value_slope_at(VALUE_KEYS v, value_noise_at(noise));
        EXACT float4 entry = value_keys[v.first - 1u];
        EXACT float rate = exact_div(slope * value_noise_rate(noise), entry.z);
        return rate;
    }
    if (clock != KILN_CLOCK_TIME)
        return 0.0f;
    return value_slope_at(VALUE_KEYS v, c.time_s);
}

/* Does value_rate_at for a value that is not plain. */
FN_APART float value_rate_of_keys(VALUE_KEYS_PARAM S(kiln_value) v, S(value_clocks) c)
{
    EXACT float result = 0.0f;
    EXACT float rate = 0.0f;
    for (uint part = 0u; part < VALUE_ENTRIES; part++) {
        bool has = part == 0u || (v.how & (part == 1u ? VALUE_TIMES : VALUE_PLUS)) != 0u;
        if (!has)
            continue;
        S(kiln_value) one = value_part(VALUE_KEYS v, part);
        EXACT float y = one.constant;
        EXACT float change = 0.0f;
        if (one.count != 0u) {
            y = value_curve_at(VALUE_KEYS one, value_clock(VALUE_KEYS one, c));
            change = value_curve_rate_at(VALUE_KEYS one, c);
        }
        EXACT float of_product = rate * y + result * change;
        EXACT float of_sum = rate + change;
        rate = part == 1u ? of_product : of_sum;
        EXACT float product = result * y;
        EXACT float sum = result + y;
        result = part == 1u ? product : sum;
    }
    EXACT float limited = value_limited(VALUE_KEYS v, result);
    return limited == result ? rate : 0.0f;
}

/* Returns how fast a value changes with the time, per second: 0 before the first and from the last
 * key on, and where the value is at a limit. */
FN float value_rate_at(VALUE_KEYS_PARAM S(kiln_value) v, S(value_clocks) c)
{
    if (v.count == 0u)
        return 0.0f;
    if (VALUE_USES(VALUE_USES_PARTS) && VALUE_NOT_PLAIN(v.how))
        return value_rate_of_keys(VALUE_KEYS v, c);
    return value_curve_rate_at(VALUE_KEYS v, c);
}

/* Returns the integral of a plain curve over life from 0 to x >= 0. If no value is negative, it
 * never falls as x rises, also in floats. For a rising piece, the area from its left end is a
 * product of two factors that both grow. For a falling piece, the area to its right end is a
 * product of two factors that both shrink. */
FN float value_sum_of_keys(VALUE_KEYS_PARAM S(kiln_value) v, float x)
{
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

/* Returns the integral over life from 0 to x >= 0 of a value that may be integrated: of a curve
 * over life, or of what is the same for the whole life, as its parts are. It does not keep the
 * value's limits; such values are within them by themselves. */
FN float value_sum_at(VALUE_KEYS_PARAM S(kiln_value) v, S(value_clocks) c, float x)
{
    EXACT float flat_sum = v.constant * x;
    if (v.count == 0u)
        return flat_sum;
    bool alone = !(VALUE_USES(VALUE_USES_PARTS) && (v.how & (VALUE_TIMES | VALUE_PLUS)) != 0u);
    EXACT float sum = 0.0f;
    for (uint part = 0u; part < VALUE_ENTRIES; part++) {
        bool has =
            part == 0u || (!alone && (v.how & (part == 1u ? VALUE_TIMES : VALUE_PLUS)) != 0u);
        if (!has)
            continue;
        S(kiln_value) one = value_part(VALUE_KEYS v, part);
        EXACT float y = one.constant;
        bool over_life = one.count != 0u && VALUE_CLOCK(one.how) == KILN_CLOCK_LIFE;
        if (one.count != 0u && !over_life)
            y = value_at_key(VALUE_KEYS one, value_clock(VALUE_KEYS one, c));
        EXACT float area = y * x;
        if (over_life)
            area = value_sum_of_keys(VALUE_KEYS one, x);
        EXACT float product = sum * y;
        EXACT float both = sum + area;
        sum = part == 1u ? product : both;
    }
    return sum;
}

/* Returns the integral over the time, from the birth of a particle to its age, of a value that may
 * be integrated: a rate in 1/s gives a number. c.time_s: now. */
FN float value_number_at(VALUE_KEYS_PARAM S(kiln_value) v, S(value_clocks) c, float progress,
                         float life_s)
{
    if (v.count == 0u || VALUE_CLOCK(v.how) != KILN_CLOCK_TIME) {
        EXACT float number = value_sum_at(VALUE_KEYS v, c, progress) * life_s;
        return number;
    }
    EXACT float age_s = progress * life_s;
    EXACT float born_s = c.time_s - age_s;
    EXACT float before = value_sum_of_keys(VALUE_KEYS v, born_s);
    EXACT float area = value_sum_of_keys(VALUE_KEYS v, c.time_s) - before;
    EXACT float sum = area > 0.0f ? area : 0.0f;
    if (VALUE_USES(VALUE_USES_PARTS) && (v.how & VALUE_TIMES) != 0u) {
        EXACT float factor = value_at(VALUE_KEYS value_part(VALUE_KEYS v, 1u), c);
        sum = sum * factor;
    }
    if (VALUE_USES(VALUE_USES_PARTS) && (v.how & VALUE_PLUS) != 0u) {
        EXACT float more = value_at(VALUE_KEYS value_part(VALUE_KEYS v, 2u), c);
        sum = sum + more * age_s;
    }
    return sum;
}

#endif
