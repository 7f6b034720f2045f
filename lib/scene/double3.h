/* Computes products of vectors of doubles, in which nodes and paths are computed. */
#ifndef KILN_SCENE_DOUBLE3_H
#define KILN_SCENE_DOUBLE3_H

#include <math.h>

static inline double double3_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double double3_length(const double v[3])
{
    return sqrt(double3_dot(v, v));
}

/* y may be neither of them. */
static inline void double3_cross(double y[3], const double a[3], const double b[3])
{
    y[0] = a[1] * b[2] - a[2] * b[1];
    y[1] = a[2] * b[0] - a[0] * b[2];
    y[2] = a[0] * b[1] - a[1] * b[0];
}

/* Rotates v by a unit quaternion (x, y, z, w). y may be neither of them. */
static inline void double3_rotate(double y[3], const double turn[4], const double v[3])
{
    double across[3], more[3];
    double3_cross(across, turn, v);
    double3_cross(more, turn, across);
    for (int c = 0; c < 3; c++)
        y[c] = v[c] + 2 * (turn[3] * across[c] + more[c]);
}

#endif
