/* Reads the grids of the smoke's optical depth, whose third axis points to a light
 * (lib/draw/light/smoke_shadow.h), for light on surfaces and on sprites. GL samples a grid as a
 * texture (draw/light/smoke_shadow.glsl), the device `cpu` gathers its cells
 * (draw/light/ray_smoke.h); both use the functions of this file. */
#ifndef KILN_SHARED_SMOKE_GRID_H
#define KILN_SHARED_SMOKE_GRID_H

#include "shared/real.h"

/* Returns where a world position is in a grid, 0 to 1 along each axis. x, y, z: rows of the map. */
REAL_FN real3 smoke_grid_place(float4 x, float4 y, float4 z, real3 position)
{
    real3 p = position;
    return REAL3(x.x * p.x + x.y * p.y + x.z * p.z + x.w, y.x * p.x + y.y * p.y + y.z * p.z + y.w,
                 z.x * p.x + z.y * p.y + z.z * p.z + z.w);
}

/* Returns whether the light crosses smoke on its way to a place in the grid. It does not for places
 * beside the smoke, or between the smoke and the light. Light to a place behind the smoke crosses
 * all of it. */
REAL_FN truth smoke_grid_shades(real3 at)
{
    real least = real_min(at.x, at.y);
    real most = real_max(real_max(at.x, at.y), at.z);
    return truth_and(least >= 0.0f, most <= 1.0f);
}

/* Returns the part of the light that crosses an optical depth. */
REAL_FN real smoke_transmittance(real optical_depth)
{
    return real_exp(-optical_depth);
}

/* Returns how fast light that smoke scatters falls off, as a part of how fast straight light does,
 * at most 1. White smoke glows from inside; black smoke does not. reflected: the part of the light
 * that thick smoke reflects, 0 to 1, which is what its colour shows.
 *
 * Smoke that scatters the part a of the light that meets it, forward with the mean cosine g, is
 * like smoke that scatters to all sides with s^2 = (1 - a) / (1 - a g). Thick smoke of that kind
 * reflects about (1 - s) / (1 + 1.3 s) (van de Hulst 1980, "Multiple Light Scattering", within
 * 0.02), which solved for s is the line below. Light inside of it falls off as exp(-k depth) with
 * k = sqrt(3 (1 - a) (1 - a g)) (diffusion approximation: Stam 1995, "Multiple scattering as a
 * diffusion process"). Here g is 0.4. */
REAL_FN real smoke_diffusion(real reflected)
{
    const float g = 0.4f;
    real part = real_clamp01(reflected);
    real s = (1.0f - part) / (1.0f + 1.3f * part);
    return real_min(1.7320508f * s * (1.0f - g) / (1.0f - g * s * s), real_all(1.0f));
}

#endif
