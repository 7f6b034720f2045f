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

/* Computes value_at for all lanes. x holds the time of each lane on `clock`; a value with another
 * clock is the same for all lanes and evaluated at time_s. */
static inline void kiln_lanes_values(const float4 *keys, struct kiln_value v, uint32_t clock,
                                     const float *x, float time_s, float *y)
{
    if (v.count != 0 && v.clock == clock) {
        kiln_lanes_evaluate(keys, v, x, y);
        return;
    }
    const float all = value_at(keys, v, time_s, 0.0f);
    for (uint32_t i = 0; i < KILN_LANES; i++)
        y[i] = all;
}

/* Computes particle_life_s, and particle_age_before. */
static inline void kiln_lanes_find_ages(struct kiln_lanes *lanes, const float4 *keys,
                                        struct kiln_derived_params derived, uint32_t step,
                                        float back)
{
    for (uint32_t i = 0; i < KILN_LANES; i++)
        lanes->born_s[i] = particle_birth_time(derived, kiln_lanes_record(lanes, i));
    const struct kiln_range *life = &derived.life;
    kiln_lanes_values(keys, life->min, KILN_CLOCK_TIME, lanes->born_s, 0.0f, lanes->life_min_s);
    kiln_lanes_values(keys, life->max, KILN_CLOCK_TIME, lanes->born_s, 0.0f, lanes->life_max_s);
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        struct kiln_particle p = kiln_lanes_record(lanes, i);
        lanes->life_s[i] = random_between(particle_stream(derived, p), RANDOM_LIFE,
                                          lanes->life_min_s[i], lanes->life_max_s[i]);
        lanes->age_s[i] = particle_age_before(p, step, back, derived.dt_s);
    }
}

#endif
