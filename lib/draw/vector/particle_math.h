/* This header computes values of a vector of particles, with the same bits as shaders/shared
 * computes them for one particle (exact.h, random.h, derived.h). */
#ifndef KILN_DRAW_VECTOR_PARTICLE_MATH_H
#define KILN_DRAW_VECTOR_PARTICLE_MATH_H

#include "base/transpose.h"
#include "shared/derived.h"
#include "shared/heading.h"

/* Returns 1 / x as exact_rcp does. */
SIMD vf vf_rcp(vf x)
{
    vi size = (vi)x & (int32_t)EXACT_SIZE_BITS;
    vi usual = (size >= (int32_t)EXACT_TINY_BITS) & (size <= (int32_t)EXACT_VAST_BITS);
    vf y = vf_rcp_within((vf)size);
    return (vf)(((vi)y | ((vi)x & (int32_t)EXACT_SIGN_BIT)) & usual);
}

/* Interpolates from a at t = 0 to b at t = 1. */
SIMD vf vf_lerp(vf a, vf b, vf t)
{
    return a + (b - a) * t;
}

/* Interpolates as exact_lerp does: the result is within a and b for t from 0 to 1. */
SIMD vf vf_lerp_clamped(vf a, vf b, vf t)
{
    return vf_min(vf_max(vf_lerp(a, b, t), vf_min(a, b)), vf_max(a, b));
}

/* ---- random numbers -------------------------------------------------------------------------- */

/* Mixes bits as random_mix does. */
SIMD vu vu_mix(vu x)
{
    x ^= x >> 16;
    x *= 0x21f0aaadu;
    x ^= x >> 15;
    x *= 0xd35a2d97u;
    x ^= x >> 15;
    return x;
}

/* Returns random numbers as random_unit does. */
SIMD vf vu_unit(vu stream, uint32_t purpose)
{
    vu bits = vu_mix(stream ^ random_mix(purpose + 0x9e3779b9u));
    return vf_of((vi)(bits >> 8)) * 5.9604644775390625e-8f;
}

/* ---- records --------------------------------------------------------------------------------- */

/* Holds the members of struct kiln_particle for a vector of particles. */
struct vf_particles {
    struct vf3 position, velocity;
    vu serial, birth;
    vi stopped; /* a mask of particles that have stopped */
    vu rest;    /* of these, the time at which they did: the first word of their rest */
    vu heading; /* of these, the last word of their rest: heading.h */
};

/* Reads the particles in slots of a pool's records. */
SIMD struct vf_particles read_records(const struct kiln_particle *records, vi slots)
{
    const struct lane_offsets places =
        lane_offsets_of(slots * (int32_t)(sizeof *records / sizeof(float)));
    const float *from = (const float *)(const void *)records;
    const struct columns first = columns_load(from, &places),
                         second = columns_load(from + 4, &places);
    const vu birth = (vu)second.c[3];
    const vi stopped = (vi)(birth & KILN_PARTICLE_STOPPED) != 0;
    struct vf3 velocity = {second.c[0], second.c[1], second.c[2]};
    if (any(stopped))
        velocity = (struct vf3){vf_where(~stopped, velocity.x), vf_where(~stopped, velocity.y),
                                vf_where(~stopped, velocity.z)};
    return (struct vf_particles){.position = {first.c[0], first.c[1], first.c[2]},
                                 .velocity = velocity,
                                 .serial = (vu)first.c[3],
                                 .birth = birth,
                                 .stopped = stopped,
                                 .rest = (vu)second.c[0],
                                 .heading = (vu)second.c[2]};
}

/* Returns vectors along the headings of particles, as particle_heading does. */
SIMD struct vf3 vf_heading(const struct vf_particles *p)
{
    struct vf3 y = p->velocity;
    for (int i = 0; any(p->stopped) && i < LANES; i++) {
        if (!p->stopped[i])
            continue;
        const float3 heading = heading_unpack(p->heading[i]);
        y.x[i] = heading.x;
        y.y[i] = heading.y;
        y.z[i] = heading.z;
    }
    return y;
}

SIMD vf vf_birth_fraction(vu birth)
{
    return vf_of((vi)(birth >> KILN_BIRTH_FRACTION_SHIFT & KILN_BIRTH_FRACTION_MASK)) * 0.015625f;
}

/* Returns the age in seconds as particle_age_before does. */
SIMD vf vf_age(vu birth, uint32_t step, float back, float dt_s)
{
    vf steps = vf_of((vi)(step - (birth >> KILN_BIRTH_STEP_SHIFT))) + 1.0f;
    return (steps - vf_birth_fraction(birth) - back) * dt_s;
}

/* Returns for how long particles have turned by themselves, as particle_turned_s does. */
SIMD vf vf_turned(const struct vf_particles *p, vf age_s, float dt_s)
{
    if (!any(p->stopped))
        return age_s;
    const vf whole =
        vf_of((vi)((p->rest >> KILN_REST_STEP_SHIFT) - (p->birth >> KILN_BIRTH_STEP_SHIFT)));
    const vf part = vf_of((vi)(p->rest & KILN_BIRTH_FRACTION_MASK)) * 0.015625f;
    const vf stopped_s = (whole + part - vf_birth_fraction(p->birth)) * dt_s;
    return vf_select(p->stopped, vf_min(stopped_s, age_s), age_s);
}

/* Returns a value that particles get at their births. Most values are constant, so others are
 * evaluated lane by lane. */
SIMD vf vf_value_at_birth(const float4 *keys, const struct kiln_value *value,
                          const struct kiln_derived_params *d, vf time_s, vu stream)
{
    if (value->count == 0)
        return vf_all(value->constant);
    vf y;
    for (int i = 0; i < LANES; i++)
        y[i] = value_at(keys, *value,
                        value_clocks_of_birth(time_s[i], d->random_key, d->scene_key, stream[i]));
    return y;
}

/* Returns the lifetime in seconds as particle_life_s does. */
SIMD vf vf_life(const float4 *keys, const struct kiln_derived_params *d, vu stream, vu birth)
{
    vf before = vf_of((vi)((birth >> KILN_BIRTH_STEP_SHIFT) - 1u)) - (float)d->warmup_steps;
    vf born_s = (before + vf_birth_fraction(birth)) * d->dt_s;
    return vf_lerp_clamped(vf_value_at_birth(keys, &d->life.min, d, born_s, stream),
                           vf_value_at_birth(keys, &d->life.max, d, born_s, stream),
                           vu_unit(stream, RANDOM_LIFE));
}

/* Returns the progress through life, 0 to 1, as particle_progress does. */
SIMD vf vf_progress(vf age_s, vf life_s)
{
    return vf_clamp01(age_s * vf_rcp(life_s));
}

#endif
