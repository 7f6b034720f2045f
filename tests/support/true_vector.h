/* Declares vectors in double precision for the reference rasteriser (true_billboards.h), and a
 * function that reads how particles look at an age, such as colour and size, in double precision.
 */
#ifndef KILN_TESTS_TRUE_VECTOR_H
#define KILN_TESTS_TRUE_VECTOR_H

#include <math.h>

#include "shared/draw_layout.h"

typedef struct {
    double x, y, z;
} dvec;

static inline dvec dvec_of(float4 v)
{
    return (dvec){(double)v.x, (double)v.y, (double)v.z};
}

static inline dvec dvec_of3(float3 v)
{
    return (dvec){(double)v.x, (double)v.y, (double)v.z};
}

static inline double dvec_dot(dvec a, dvec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Returns a + b * t. */
static inline dvec dvec_add(dvec a, dvec b, double t)
{
    return (dvec){a.x + b.x * t, a.y + b.y * t, a.z + b.z * t};
}

static inline dvec dvec_scale(dvec a, double t)
{
    return (dvec){a.x * t, a.y * t, a.z * t};
}

static inline dvec dvec_cross(dvec a, dvec b)
{
    return (dvec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline dvec dvec_unit(dvec a)
{
    return dvec_scale(a, 1 / sqrt(dvec_dot(a, a)));
}

/* Returns one coordinate of the point p after an affine transformation. row: the matrix row of that
 * coordinate, with the translation in w.
 */
double dvec_row(float4 row, dvec p);

/* Transform from world space to view space: dvec_view a point, m, and dvec_turn a direction. */
dvec dvec_view(const struct kiln_view *view, dvec p);
dvec dvec_turn(const struct kiln_view *view, dvec v);

/* Reads four values of a system's look from the table of shared/look_layout.h, interpolated
 * linearly between its samples. system: index; row: which values, KILN_LOOK_*; life: the particle's
 * age as a fraction of its life, 0 to 1. */
void dvec_look(const float4 *table, uint32_t system, uint32_t row, float life, double out[4]);

#endif
