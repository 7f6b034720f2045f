/* Computes the floor's look: squares, and the gloss of a floor that is wet, or of water. A glossy
 * floor reflects sky, shapes and lamps by Fresnel's law for water. Waves tilt it; those too small
 * for a pixel widen the lamps' streaks instead, which a rough surface seen at a flat angle draws
 * out towards the eye (a microfacet lobe, GGX). Particles are reflected by the light alone that
 * they shed, and meshes not at all: their rays are rasterised from the eye. */
#ifndef KILN_SHARED_FLOOR_H
#define KILN_SHARED_FLOOR_H

#include "shared/surface_light.h"

/* ---- squares --------------------------------------------------------------------------------- */

/* Holds the extent of floor that a pixel covers, m. */
struct floor_extent {
    real x, z;
};

/* Returns the extent of floor that a pixel covers. It is longer along the view where the floor is
 * seen at a flat angle. pixel: size of a pixel at the distance of t = 1, m. */
REAL_FN S(floor_extent) floor_extent_of(real3 direction, real t, float pixel)
{
    real flat2 = direction.x * direction.x + direction.z * direction.z;
    real length2 = flat2 + direction.y * direction.y;
    real inverse = real_rsqrt(real_max(flat2, real_all(1e-12f)));
    real stretch =
        length2 * real_rsqrt(length2) / real_max(real_abs(direction.y), real_all(1e-6f)) * inverse;
    S(floor_extent) extent;
    extent.x = pixel * t * (1.0f + real_abs(direction.x) * stretch);
    extent.z = pixel * t * (1.0f + real_abs(direction.z) * stretch);
    return extent;
}

/* Returns the integral of a square wave of period 2. */
REAL_FN real square_integral(real x)
{
    real cycles = x * 0.5f;
    return 1.0f - real_abs((cycles - real_floor(cycles)) * 2.0f - 1.0f);
}

/* Returns the factor of the floor's colour at (x, z): squares of two shades, averaged over the
 * extent of a pixel, so that they do not alias. edge: of a square, m. */
REAL_FN real floor_checkers(real x, real z, float edge, S(floor_extent) extent)
{
    float inverse = 1.0f / edge;
    real wide_x = real_max(extent.x * inverse, real_all(1e-3f));
    real wide_z = real_max(extent.z * inverse, real_all(1e-3f));
    real at_x = x * inverse, at_z = z * inverse;
    real wave_x = square_integral(at_x + 0.5f * wide_x) - square_integral(at_x - 0.5f * wide_x);
    real wave_z = square_integral(at_z + 0.5f * wide_z) - square_integral(at_z - 0.5f * wide_z);
    return 1.0f + 0.2f * (wave_x * wave_z) / (wide_x * wide_z);
}

/* ---- water ----------------------------------------------------------------------------------- */

/* Holds the sum of waves so far. */
struct floor_water {
    real x, z;             /* where the next wave is read */
    real slope_x, slope_z; /* slope of the water */
    real averaged;         /* mean square of the slopes that are averaged within a pixel */
};

/* Adds a wave of kiln_draw_shapes. Each wave is shifted by the longer waves before it, so that
 * crests are short. steepness: the largest slope of each wave. */
REAL_FN S(floor_water) floor_add_wave(S(floor_water) sum, float4 wave, float4 shift,
                                      float steepness, S(floor_extent) extent)
{
    real phase = wave.z * (wave.x * sum.x + wave.y * sum.z) - wave.w;
    real across = wave.z * (exact_abs(wave.x) * extent.x + exact_abs(wave.y) * extent.z);
    real seen = real_exp(-0.2f * across * across);
    real tilt = steepness * seen * real_cos(phase), sine = real_sin(phase);
    S(floor_water) added = sum;
    added.slope_x = sum.slope_x + wave.x * tilt;
    added.slope_z = sum.slope_z + wave.y * tilt;
    added.averaged = sum.averaged + 0.5f * steepness * steepness * (1.0f - seen * seen);
    added.x = sum.x + shift.x * sine;
    added.z = sum.z + shift.y * sine;
    return added;
}

/* ---- gloss ----------------------------------------------------------------------------------- */

/* Returns the part of light that water reflects (Schlick). */
REAL_FN real fresnel(real cosine)
{
    real away = 1.0f - real_clamp01(cosine);
    real away2 = away * away;
    return 0.02f + 0.98f * away2 * away2 * away;
}

/* Returns the part of the irradiance along `to_light` that is reflected to the eye, per solid
 * angle. All directions are unit. */
REAL_FN real floor_lobe(real3 normal, real3 to_eye, real3 to_light, real spread)
{
    real3 half_way = real3_normalize(real3_add(to_eye, to_light));
    real a2 = spread * spread;
    real nh = real_clamp01(real3_dot(normal, half_way));
    real nv = real_clamp(real3_dot(normal, to_eye), 1e-3f, 1.0f);
    real nl = real_clamp01(real3_dot(normal, to_light));
    real d = nh * nh * (a2 - 1.0f) + 1.0f;
    real distribution = a2 / (SURFACE_PI * d * d);
    real shadowing =
        nl * real_sqrt(nv * nv * (1.0f - a2) + a2) + nv * real_sqrt(nl * nl * (1.0f - a2) + a2);
    return fresnel(real3_dot(to_eye, half_way)) * distribution * 0.5f * nl /
           real_max(shadowing, real_all(1e-6f));
}

/* Returns what reaches the eye for each unit of a lamp's colour where the lamp faces the floor.
 * towards: to the lamp's centre; radius2: the square of its radius. A large lamp has a wide streak.
 */
REAL_FN real floor_reflects_lamp(real3 towards, float radius2, real3 normal, real3 to_eye,
                                 real spread)
{
    real d2 = real_max(real3_dot(towards, towards), real_all(1e-6f));
    real wide = real_min(spread + 0.25f * real_sqrt(radius2 / d2), real_all(1.0f));
    return SURFACE_PI / (d2 + radius2) *
           floor_lobe(normal, to_eye, real3_scale(towards, real_rsqrt(d2)), wide);
}

/* Describes the floor where a ray from the eye meets it. */
struct floor_reflection {
    real3 normal, to_eye; /* unit */
    real spread;          /* of reflections: the roughness, with the waves that are averaged */
    real3 direction;      /* of the reflected ray */
    real reflectance;     /* part of the light along it that reaches the eye */
};

/* roughness: of the floor without waves. */
REAL_FN S(floor_reflection) floor_reflection_of(real3 direction, S(floor_water) water,
                                                float roughness)
{
    S(floor_reflection) m;
    m.normal = real3_normalize(REAL3(-water.slope_x, real_all(1.0f), -water.slope_z));
    real3 way = real3_scale(direction, 1.0f / real3_length(direction));
    m.to_eye = real3_scale(way, real_all(-1.0f));
    m.spread = real_clamp(real_sqrt(roughness * roughness + 2.0f * water.averaged), 0.02f, 1.0f);
    m.direction = real3_add_scaled(way, m.normal, -2.0f * real3_dot(way, m.normal));
    /* A ray that goes down would meet a wave again. */
    m.direction.y = real_max(m.direction.y, real_all(0.01f));
    m.reflectance = fresnel(real3_dot(m.normal, m.to_eye));
    return m;
}

#endif
