/* Holds how boxes and cylinders look from the sun: what follows from directions alone, for
 * shared/sun_cover.h. They are members of uniform blocks, so each has the size of a vec4. */
#ifndef KILN_SHARED_SUN_EDGES_H
#define KILN_SHARED_SUN_EDGES_H

#include "shared/exact.h"

/* ---- boxes ----------------------------------------------------------------------------------- */

/* Holds what follows from the sun's direction along a box's axes. A box's outline along that
 * direction is a hexagon, the common part of three strips. A strip's edges lie along one axis: each
 * where a face that light enters of one of the other two axes meets a face that it leaves of the
 * other. A strip is x, y: the squares of the inverse direction along these two axes; z: 1 / (x +
 * y); w: the root of that. */
struct sun_edges {
    float4 inverse; /* of the direction along x, y and z; large where that is 0 */
    float4 later;   /* how much later light leaves a slab, by how far aside it passes */
    float4 xy, yz, xz;
    /* How much edges along x and y (x), and those along z and another axis (y), look like one: 1
     * where they are parallel. */
    float4 alike;
};

FN float4 sun_strip_of(float inverse_a, float inverse_b)
{
    float square_a = inverse_a * inverse_a, square_b = inverse_b * inverse_b;
    float sum = 1.0f / (square_a + square_b);
    return FLOAT4(square_a, square_b, sum, SQRT(sum));
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
    e.inverse =
        FLOAT4(sun_inverse(towards.x), sun_inverse(towards.y), sun_inverse(towards.z), 0.0f);
    e.later = FLOAT4(sun_later(e.inverse.x), sun_later(e.inverse.y), sun_later(e.inverse.z), 0.0f);
    e.xy = sun_strip_of(e.inverse.x, e.inverse.y);
    e.yz = sun_strip_of(e.inverse.y, e.inverse.z);
    e.xz = sun_strip_of(e.inverse.x, e.inverse.z);
    float along_z =
        exact_max(sun_likeness(towards.y, towards.z), sun_likeness(towards.x, towards.z));
    e.alike = FLOAT4(sun_likeness(towards.x, towards.y), along_z, 0.0f, 0.0f);
    return e;
}

/* ---- cylinders ------------------------------------------------------------------------------- */

/* Holds how a capped cylinder looks from the sun: a band along `up`, with round ends. */
struct sun_band {
    float4 right, up;
    /* Of its axis: sine and cosine of the angle to the picture's plane; 1 or -1, whether it points
     * along `up` or against it. */
    float4 lean;
};

/* axis: unit; aside: unit, across the sun's direction, for a cylinder that is seen along its axis.
 */
FN S(sun_band) sun_band_of(float3 axis, float3 sun, float3 aside)
{
    S(sun_band) band;
    float climb = float3_dot(axis, sun);
    float slant = SQRT(exact_max(1.0f - climb * climb, 1e-6f));
    float3 across = float3_cross(axis, sun);
    float3 level = float3_scale(across, 1.0f / slant);
    float3 right = aside;
    if (slant > 1e-3f)
        right = level;
    float3 up = float3_cross(sun, right);
    band.right = FLOAT4(right.x, right.y, right.z, 0.0f);
    band.up = FLOAT4(up.x, up.y, up.z, 0.0f);
    band.lean = FLOAT4(climb, slant, float3_dot(axis, up) < 0.0f ? -1.0f : 1.0f, 0.0f);
    return band;
}

#endif
