/* Computes the light that arrives at a surface from the sky, the sky's colour, and how much of the
 * sky a mesh hides from surfaces near it. */
#ifndef KILN_SHARED_SURFACE_LIGHT_H
#define KILN_SHARED_SURFACE_LIGHT_H

#include "shared/shape.h"

#define SURFACE_PI 3.14159265f

/* Returns the part of the sky that a mesh does not hide: that of the ellipsoid in its bounds. In a
 * hollow of a mesh, its middle is in front of the surface, so hollows get darker. */
REAL_FN real sky_beside_mesh(real3 towards, float4 halves, real3 normal)
{
    real3 parts = REAL3(towards.x * (1.0f / exact_max(halves.x, 1e-4f)),
                        towards.y * (1.0f / exact_max(halves.y, 1e-4f)),
                        towards.z * (1.0f / exact_max(halves.z, 1e-4f)));
    real away = real_max(real3_length(parts) - 1.0f, real_all(0.0f));
    real fall = 1.0f / (1.0f + 2.0f * away);
    real facing = sky_facing(real3_dot(towards, normal), real3_dot(towards, towards));
    return sky_left(facing, fall * fall);
}

/* ---- light ----------------------------------------------------------------------------------- */

/* Returns the sky's colour along a ray. */
REAL_FN real3 sky_gradient(float4 horizon, float4 top, real3 direction)
{
    real up = real_clamp01(real3_normalize(direction).y);
    return real3_mix_all(horizon, top, 1.0f - real_exp(-4.0f * up));
}

/* Returns how bright the sky glows along a ray, in parts of the glow at the sun's middle. sun: the
 * unit vector towards it; width: the distance between unit vectors at which a third is left. */
REAL_FN real sky_glow(real3 direction, float4 sun, float width)
{
    real3 away = real3_sub(real3_normalize(direction), real3_all(sun));
    real near = 1.0f / (1.0f + real3_dot(away, away) * (1.0f / (width * width)));
    return near * real_sqrt(near);
}

/* Returns the part of a pixel that the sun's disc fills, 0 to 1. sun: the unit vector towards it,
 * and its radius in w; pixel: the size of a pixel; both as distances between unit vectors. */
REAL_FN real sky_disc(real3 direction, float4 sun, float pixel)
{
    real3 away = real3_sub(real3_normalize(direction), real3_all(sun));
    return 1.0f - real_smoothstep(sun.w - 0.5f * pixel, sun.w + 0.5f * pixel, real3_length(away));
}

/* Returns the radiance of the whole sky above a surface, averaged. */
REAL_FN real3 sky_ambient(float4 horizon, float4 top, real3 normal)
{
    return real3_mix_all(horizon, top, 0.5f + 0.5f * normal.y);
}

#endif
