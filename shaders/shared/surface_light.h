/* Computes the light that arrives at a surface from the sky, and the sky's colour. Each object
 * darkens the sky for surfaces near it. The darkening does not follow the exact solid angle; it
 * makes objects look as if they stood on the floor. */
#ifndef KILN_SHARED_SURFACE_LIGHT_H
#define KILN_SHARED_SURFACE_LIGHT_H

#include "shared/real.h"

#define SURFACE_PI 3.14159265f

/* ---- the sky beside objects ------------------------------------------------------------------ */

/* Returns how much a surface is turned towards an object, 0 to 1; a little of an object behind the
 * surface counts as well. along_normal: of the way to the object's middle. */
REAL_FN real sky_facing(real along_normal, real distance2)
{
    return real_clamp01(along_normal * real_rsqrt(real_max(distance2, real_all(1e-9f))) + 0.4f);
}

/* Returns the part of the sky that an object does not hide. fall: the part of the view that it
 * fills, 0 to 1. */
REAL_FN real sky_left(real facing, real fall)
{
    return 1.0f - 0.7f * facing * fall;
}

/* Returns whether a box hides any sky; a box that is wholly behind the surface hides none. The
 * vectors are in the box's frame; towards: the way to its middle. */
REAL_FN truth sky_meets_box(float4 halves, real3 towards, real3 normal)
{
    real reach =
        real3_dot_all(REAL3(real_abs(normal.x), real_abs(normal.y), real_abs(normal.z)), halves);
    return real3_dot(towards, normal) > 1e-3f - reach;
}

REAL_FN real sky_beside_box(float4 halves, real3 towards, real3 normal)
{
    real zero = real_all(0.0f);
    real3 beyond = REAL3(real_max(real_abs(towards.x) - halves.x, zero),
                         real_max(real_abs(towards.y) - halves.y, zero),
                         real_max(real_abs(towards.z) - halves.z, zero));
    float size = exact_min(exact_min(halves.x, halves.y), halves.z);
    real fall = size / (size + 2.0f * real3_length(beyond));
    real facing = sky_facing(real3_dot(towards, normal), real3_dot(towards, towards));
    return sky_left(facing, fall * fall);
}

REAL_FN real sky_beside_ball(real3 towards, float radius, real3 normal)
{
    real distance2 = real_max(real3_dot(towards, towards), real_all(1e-9f));
    real fall = real_min(radius * radius / distance2, real_all(1.0f));
    return sky_left(sky_facing(real3_dot(towards, normal), distance2), fall);
}

/* Returns the part of the sky that a capsule does not hide: that of the nearest of the balls that
 * form it. axis: unit, w: half of its height without the ends. */
REAL_FN real sky_beside_capsule(real3 towards, float radius, float4 axis, real3 normal)
{
    real along = real_clamp(-real3_dot_all(towards, axis), -axis.w, axis.w);
    return sky_beside_ball(real3_add_scaled(towards, real3_all(axis), along), radius, normal);
}

/* Returns whether a cylinder hides any sky, as sky_meets_box does for a box. axis: unit, w: half of
 * the cylinder's height. */
REAL_FN truth sky_meets_cylinder(real3 towards, float radius, float4 axis, real3 normal)
{
    real climb = real3_dot_all(normal, axis);
    real slant = real_sqrt(real_max(1.0f - climb * climb, real_all(0.0f)));
    return real3_dot(towards, normal) > 1e-3f - (axis.w * real_abs(climb) + radius * slant);
}

REAL_FN real sky_beside_cylinder(real3 towards, float radius, float4 axis, real3 normal)
{
    float size = exact_min(axis.w, radius);
    real height = real3_dot_all(towards, axis);
    real3 aside = real3_add_scaled(towards, real3_all(axis), -height);
    real above = real_max(real_abs(height) - axis.w, real_all(0.0f));
    real beside = real_max(real3_length(aside) - radius, real_all(0.0f));
    real fall = size / (size + 2.0f * real_sqrt(above * above + beside * beside));
    real facing = sky_facing(real3_dot(towards, normal), real3_dot(towards, towards));
    return sky_left(facing, fall * fall);
}

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
