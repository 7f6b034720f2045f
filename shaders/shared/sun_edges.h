/* Computes the values of shared/sun_cover.h that depend on the directions of the sun and of a shape
 * alone. They are members of uniform blocks, so each has the size of a vec4. */
#ifndef KILN_SHARED_SUN_EDGES_H
#define KILN_SHARED_SUN_EDGES_H

#include "shared/exact.h"

/* ---- boxes ----------------------------------------------------------------------------------- */

/* The outline of a box as seen from the sun. It is a hexagon, the intersection of three strips. The
 * two edges of a strip are edges of the box that lie along one axis. At each, a face that light
 * enters, of one of the other two axes, meets a face that light leaves, of the other. A strip is
 * (x, y, z, w): x and y are the squares of the inverse direction along these two axes, z is
 * 1 / (x + y), and w is the root of z. */
struct sun_edges {
    float4 inverse; /* 1 / direction along x, y and z; large where the direction is 0 */
    float4 later;   /* how much later light leaves a slab for each metre that it passes aside */
    float4 xy, yz, xz;
    /* How much two edges coincide in the outline, 1 if they are parallel there. x: edges along x
     * and y; y: edges along z and another axis. */
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

/* Returns the outline of a box. towards: unit, to the sun in the box's frame. */
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
    /* Sine and cosine of the angle between the axis and the plane across the sun's direction; 1 if
     * the axis points along `up`, -1 if against it. */
    float4 lean;
};

/* Returns the band of a cylinder. axis: unit; aside: unit, across the sun's direction, used for a
 * cylinder that is seen along its axis. */
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
