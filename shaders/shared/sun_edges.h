/* Holds how boxes and cylinders look from the sun: what follows from directions alone, for
 * shared/sun_cover.h. */
#ifndef KILN_SHARED_SUN_EDGES_H
#define KILN_SHARED_SUN_EDGES_H

#include "shared/exact.h"

/* ---- boxes ----------------------------------------------------------------------------------- */

/* A box's outline along the sun's direction is a hexagon, the common part of three strips. A
 * strip's edges lie along one axis: each where a face that light enters of one of the other two
 * axes meets a face that it leaves of the other. */
struct sun_strip {
    float square_a, square_b; /* of the inverse direction along the two other axes */
    float sum, scale;         /* 1 / (square_a + square_b), and the root of that */
};

/* Holds what follows from the sun's direction along a box's axes. */
struct sun_edges {
    float3 inverse;
    float3 later; /* how much later light leaves a slab, by how far aside it passes */
    S(sun_strip) xy, yz, xz;
    float alike_xy, alike_z; /* how much edges along x and y, and those along z and another, look
                                like one: 1 where they are parallel */
};

FN S(sun_strip) sun_strip_of(float inverse_a, float inverse_b)
{
    S(sun_strip) strip;
    strip.square_a = inverse_a * inverse_a;
    strip.square_b = inverse_b * inverse_b;
    strip.sum = 1.0f / (strip.square_a + strip.square_b);
    strip.scale = SQRT(strip.sum);
    return strip;
}

FN float sun_likeness(float a, float b)
{
    float cosine = a * b / SQRT(exact_max((1.0f - a * a) * (1.0f - b * b), 1e-12f));
    float square = exact_min(cosine * cosine, 1.0f);
    return square * square * square * square;
}

FN float sun_inverse(float x)
{
    return (x < 0.0f ? -1.0f : 1.0f) / exact_max(exact_abs(x), 1e-8f);
}

FN float sun_later(float inverse)
{
    return SQRT(exact_max(inverse * inverse - 1.0f, 0.0f));
}

/* towards: unit, to the sun in the box's frame. */
FN S(sun_edges) sun_edges_of(float3 towards)
{
    S(sun_edges) e;
    e.inverse = FLOAT3(sun_inverse(towards.x), sun_inverse(towards.y), sun_inverse(towards.z));
    e.later = FLOAT3(sun_later(e.inverse.x), sun_later(e.inverse.y), sun_later(e.inverse.z));
    e.xy = sun_strip_of(e.inverse.x, e.inverse.y);
    e.yz = sun_strip_of(e.inverse.y, e.inverse.z);
    e.xz = sun_strip_of(e.inverse.x, e.inverse.z);
    e.alike_xy = sun_likeness(towards.x, towards.y);
    e.alike_z = exact_max(sun_likeness(towards.y, towards.z), sun_likeness(towards.x, towards.z));
    return e;
}

/* ---- cylinders ------------------------------------------------------------------------------- */

/* Holds how a capped cylinder looks from the sun: a band along `up`, with round ends. */
struct sun_band {
    float4 right, up;
    float climb, slant; /* of its axis: sine and cosine of the angle to the picture's plane */
    float tilt;         /* 1 or -1: whether the axis points along `up` or against it */
};

/* axis: unit; aside: unit, across the sun's direction, for a cylinder that is seen along its axis.
 */
FN S(sun_band) sun_band_of(float3 axis, float3 sun, float3 aside)
{
    S(sun_band) band;
    band.climb = float3_dot(axis, sun);
    band.slant = SQRT(exact_max(1.0f - band.climb * band.climb, 1e-6f));
    float3 across = float3_cross(axis, sun);
    float3 level = float3_scale(across, 1.0f / band.slant);
    float3 right = aside;
    if (band.slant > 1e-3f)
        right = level;
    float3 up = float3_cross(sun, right);
    band.right = FLOAT4(right.x, right.y, right.z, 0.0f);
    band.up = FLOAT4(up.x, up.y, up.z, 0.0f);
    band.tilt = float3_dot(axis, up) < 0.0f ? -1.0f : 1.0f;
    return band;
}

#endif
