/* A kiln_lanes holds a block of particles for loops that compilers vectorise: each word of the
 * records has an array of its own. Files *_simd.c include this header. Every function computes the
 * same bits as the function of shaders/shared that its comment names. */
#ifndef KILN_PARTICLES_LANES_H
#define KILN_PARTICLES_LANES_H

#include <stdalign.h>

#include "shared/derived.h"

enum {
    KILN_LANES = 128,
    KILN_RECORD_WORDS = sizeof(struct kiln_particle) / sizeof(uint32_t),
    /* the most keys of a curve that all lanes search together; each lane searches a longer curve
     * alone */
    KILN_SHORT_CURVE = 12,
};

/* One number for each lane. */
typedef float kiln_floats[KILN_LANES];

struct kiln_floats3 {
    kiln_floats x, y, z;
};

struct kiln_lanes {
    alignas(64) uint32_t words[KILN_RECORD_WORDS][KILN_LANES]; /* words of the records */
    kiln_floats age_s, life_s;
    kiln_floats born_s, life_min_s, life_max_s; /* the times that life_s is computed from */
    uint32_t stream[KILN_LANES];                /* random numbers of each particle */
};

static inline float3 kiln_get3(const struct kiln_floats3 *from, uint32_t i)
{
    return (float3){from->x[i], from->y[i], from->z[i]};
}

static inline void kiln_set3(struct kiln_floats3 *to, uint32_t i, float3 v)
{
    to->x[i] = v.x;
    to->y[i] = v.y;
    to->z[i] = v.z;
}

static inline struct kiln_particle kiln_lanes_record(const struct kiln_lanes *lanes, uint32_t i)
{
    const uint32_t(*words)[KILN_LANES] = lanes->words;
    return (struct kiln_particle){
        .position_serial = {words[0][i], words[1][i], words[2][i], words[3][i]},
        .velocity_birth = {words[4][i], words[5][i], words[6][i], words[7][i]},
    };
}

/* Loads KILN_LANES records. */
static inline void kiln_lanes_load(struct kiln_lanes *lanes, const struct kiln_particle *records)
{
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        lanes->words[0][i] = records[i].position_serial.x;
        lanes->words[1][i] = records[i].position_serial.y;
        lanes->words[2][i] = records[i].position_serial.z;
        lanes->words[3][i] = records[i].position_serial.w;
        lanes->words[4][i] = records[i].velocity_birth.x;
        lanes->words[5][i] = records[i].velocity_birth.y;
        lanes->words[6][i] = records[i].velocity_birth.z;
        lanes->words[7][i] = records[i].velocity_birth.w;
    }
}

static inline void kiln_lanes_store(const struct kiln_lanes *lanes, struct kiln_particle *records)
{
    for (uint32_t i = 0; i < KILN_LANES; i++)
        records[i] = kiln_lanes_record(lanes, i);
}

/* Holds the clocks of all lanes (struct value_clocks). A pointer may be NULL where no value has
 * that clock. */
struct kiln_lane_clocks {
    const float *time_s; /* NULL: same_time_s, of all lanes */
    float same_time_s;
    const float *life, *age_s;
    const struct kiln_floats3 *position, *velocity;
    const uint32_t *stream;
    uint32_t system, scene;
};

static inline struct value_clocks kiln_lane_clocks_at(const struct kiln_lane_clocks *c, uint32_t i)
{
    struct value_clocks one =
        value_clocks_at(c->time_s ? c->time_s[i] : c->same_time_s, c->system, c->scene);
    one.life = c->life ? c->life[i] : 0.0f;
    one.age_s = c->age_s ? c->age_s[i] : 0.0f;
    one.height = c->position ? c->position->y[i] : 0.0f;
    one.velocity = c->velocity ? kiln_get3(c->velocity, i) : one.velocity;
    one.stream = c->stream ? c->stream[i] : 0u;
    return one;
}

/* Computes value_at_key for all lanes, one key after another. */
static inline void kiln_lanes_evaluate(const float4 *keys, struct kiln_value v, const float *x,
                                       float *y)
{
    if (v.count > KILN_SHORT_CURVE) {
        for (uint32_t i = 0; i < KILN_LANES; i++)
            y[i] = value_at_key(keys, v, x[i]);
        return;
    }
    const uint32_t last = v.first + v.count - 1;
    for (uint32_t i = 0; i < KILN_LANES; i++)
        y[i] = keys[v.first].y;
    for (uint32_t k = v.first; k <= last; k++) {
        const float from = keys[k].x, value = keys[k].y, slope = keys[k].z;
        const float extrapolate_from = k == last ? INFINITY : from;
        for (uint32_t i = 0; i < KILN_LANES; i++) {
            float dx = x[i] - from;
            float dy = dx * slope;
            float sum = value + dy;
            float y_here = x[i] > extrapolate_from ? sum : value;
            y[i] = x[i] >= from ? y_here : y[i];
        }
    }
}

/* Computes value_clock for all lanes. */
static inline void kiln_lanes_clock(const float4 *keys, struct kiln_value v,
                                    const struct kiln_lane_clocks *c, float *x)
{
    const uint32_t draw = RANDOM_VALUES + VALUE_DRAW(v.how);
    if (VALUE_CLOCK(v.how) == KILN_CLOCK_RANDOM && c->stream) {
        for (uint32_t i = 0; i < KILN_LANES; i++)
            x[i] = random_unit(c->stream[i], draw);
        return;
    }
    for (uint32_t i = 0; i < KILN_LANES; i++)
        x[i] = value_clock(keys, v, kiln_lane_clocks_at(c, i));
}

/* Computes value_curve_at of a value's clock for all lanes. */
static inline void kiln_lanes_curve(const float4 *keys, struct kiln_value v,
                                    const struct kiln_lane_clocks *c, float *y)
{
    kiln_floats x;
    kiln_lanes_clock(keys, v, c, x);
    if (VALUE_EASE(v.how) < VALUE_SMOOTH && VALUE_REPEAT(v.how) == VALUE_HOLDS) {
        kiln_lanes_evaluate(keys, v, x, y);
        return;
    }
    for (uint32_t i = 0; i < KILN_LANES; i++)
        y[i] = value_curve_at(keys, v, x[i]);
}

/* Computes value_of_keys for all lanes. */
static inline void kiln_lanes_parts(const float4 *keys, struct kiln_value v,
                                    const struct kiln_lane_clocks *c, float *y)
{
    kiln_floats other;
    kiln_lanes_curve(keys, v, c, y);
    for (uint32_t i = 0; i < KILN_LANES; i++)
        y[i] = 0.0f + y[i];
    for (uint32_t part = 1; part < VALUE_ENTRIES; part++) {
        if (!(v.how & (part == 1 ? VALUE_TIMES : VALUE_PLUS)))
            continue;
        const struct kiln_value one = value_part(keys, v, part);
        if (one.count != 0)
            kiln_lanes_curve(keys, one, c, other);
        for (uint32_t i = 0; i < KILN_LANES; i++) {
            const float change = one.count != 0 ? other[i] : one.constant;
            y[i] = part == 1 ? y[i] * change : y[i] + change;
        }
    }
    for (uint32_t i = 0; i < KILN_LANES; i++)
        y[i] = value_limited(keys, v, y[i]);
}

/* Returns whether a value that has keys shows the same in all lanes, which have the same time. */
static inline bool kiln_value_is_shared(struct kiln_value v)
{
    const bool is_plain = !VALUE_NOT_PLAIN(v.how);
    return v.count == 0 || (is_plain && VALUE_CLOCK(v.how) == KILN_CLOCK_TIME);
}

/* Computes value_at for all lanes. */
static inline void kiln_lanes_values(const float4 *keys, struct kiln_value v,
                                     const struct kiln_lane_clocks *c, float *y)
{
    if (v.count == 0 || (!c->time_s && kiln_value_is_shared(v))) {
        const float all = value_at(keys, v, value_clocks_at(c->same_time_s, c->system, c->scene));
        for (uint32_t i = 0; i < KILN_LANES; i++)
            y[i] = all;
        return;
    }
    if (VALUE_NOT_PLAIN(v.how)) {
        kiln_lanes_parts(keys, v, c, y);
        return;
    }
    const uint32_t clock = VALUE_CLOCK(v.how);
    if (clock == KILN_CLOCK_LIFE || clock == KILN_CLOCK_TIME) {
        kiln_lanes_evaluate(keys, v, clock == KILN_CLOCK_LIFE ? c->life : c->time_s, y);
        return;
    }
    kiln_lanes_curve(keys, v, c, y);
}

/* Computes particle_life_s, and particle_age_before. */
static inline void kiln_lanes_find_ages(struct kiln_lanes *lanes, const float4 *keys,
                                        struct kiln_derived_params derived, uint32_t step,
                                        float back)
{
    for (uint32_t i = 0; i < KILN_LANES; i++)
        lanes->born_s[i] = particle_birth_time(derived, kiln_lanes_record(lanes, i));
    for (uint32_t i = 0; i < KILN_LANES; i++)
        lanes->stream[i] = particle_stream(derived, kiln_lanes_record(lanes, i));
    const struct kiln_lane_clocks birth = {.time_s = lanes->born_s,
                                           .stream = lanes->stream,
                                           .system = derived.random_key,
                                           .scene = derived.scene_key};
    const struct kiln_range *life = &derived.life;
    kiln_lanes_values(keys, life->min, &birth, lanes->life_min_s);
    kiln_lanes_values(keys, life->max, &birth, lanes->life_max_s);
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        struct kiln_particle p = kiln_lanes_record(lanes, i);
        lanes->life_s[i] = random_between(lanes->stream[i], RANDOM_LIFE, lanes->life_min_s[i],
                                          lanes->life_max_s[i]);
        lanes->age_s[i] = particle_age_before(p, step, back, derived.dt_s);
    }
}

#endif
