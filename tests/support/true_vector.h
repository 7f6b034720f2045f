/* Declares vectors in double precision for the reference rasteriser (true_sprite.h), and reads
 * looks of systems with the same precision. */
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

/* Returns one coordinate of a point after an affine map. row: the map's row, with its offset in w.
 */
double dvec_row(float4 row, dvec p);

/* Transform a point (dvec_view) or a direction (dvec_turn) from the world to view space. */
dvec dvec_view(const struct kiln_view *view, dvec p);
dvec dvec_turn(const struct kiln_view *view, dvec v);

/* Reads a row (KILN_LOOK_*) of a system's look at a part of the life, 0 to 1, from the table of
 * shared/look_layout.h. Interpolates linearly between its samples. */
void dvec_look(const float4 *table, uint32_t system, uint32_t row, float life, double out[4]);

#endif
