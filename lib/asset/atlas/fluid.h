/* Declares a small two-dimensional fluid, which carries the gas of the procedural flipbooks. Its
 * bits are the same on every machine: it uses only IEEE arithmetic in a fixed order. */
#ifndef KILN_ASSET_ATLAS_FLUID_H
#define KILN_ASSET_ATLAS_FLUID_H

#include <stdalign.h>
#include <stdint.h>

#include "base/simd.h"

enum {
    KILN_FLUID_EDGE = 64, /* samples a side */
    KILN_FLUID_SIZE = KILN_FLUID_EDGE * KILN_FLUID_EDGE,
    KILN_FLUID_DIAGONALS = 2 * KILN_FLUID_EDGE - 1,
    /* floats before each diagonal, so that rows of vectors stay inside */
    KILN_FLUID_MARGIN = 16,
    /* floats from one diagonal to the next */
    KILN_FLUID_PITCH = KILN_FLUID_MARGIN + KILN_FLUID_EDGE,
    /* most texels a side that it is sampled at */
    KILN_FLUID_FINEST = 128,
};

/* Holds the fields of the fluid. Samples lie at the middles of squares that tile [-1, 1]^2, rows
 * from the bottom. The unit of length is half the edge of a flipbook's cell; the caller's dt sets
 * the unit of time. */
struct kiln_fluid {
    float vorticity[KILN_FLUID_SIZE];
    /* The stream function, whose curl is the velocity, so that the velocity has no divergence; then
     * a copy of the vorticity. Rows are the diagonals on which x + y is constant, columns are x. */
    alignas(64) float stream[KILN_FLUID_DIAGONALS + 2][KILN_FLUID_PITCH];
    alignas(64) float turning[KILN_FLUID_DIAGONALS][KILN_FLUID_EDGE];
    float velocity_x[KILN_FLUID_SIZE], velocity_y[KILN_FLUID_SIZE];
    float heat[KILN_FLUID_SIZE];    /* rises by buoyancy */
    float place_x[KILN_FLUID_SIZE]; /* where the gas was at its start: detail computed from it */
    float place_y[KILN_FLUID_SIZE]; /* is carried along without being blurred */
    float buoyancy;                 /* acceleration where heat is 1 */
    float swelling;                 /* relative growth of lengths in a unit of time, about (0, 0) */
    float strain;                   /* relative growth of heights, and shrinking of widths */
    float rise;                     /* speed at which all gas rises in addition */
    float drag;                     /* part of the vorticity that is lost in a unit of time */
};

/* Returns the coordinate, on [-1, 1], of the middle of a column or row. */
static inline float kiln_fluid_coordinate(uint32_t index)
{
    return ((float)index + 0.5f) * (2.0f / KILN_FLUID_EDGE) - 1.0f;
}

/* Makes all gas cold and at rest; the start place of the gas at each sample is that sample. */
void kiln_fluid_init(struct kiln_fluid *fluid);

/* Memory in which a field is sampled. */
struct kiln_fluid_scratch {
    float columns[KILN_FLUID_EDGE][3][KILN_FLUID_FINEST];
};

struct kiln_fluid_code {
    /* Makes one step. Buoyancy adds vorticity, the velocity follows from the vorticity (walls at
     * the sides, open below and above), and all fields move with it. */
    void (*step)(struct kiln_fluid *fluid, float dt);
    /* Samples a field by a quadratic B-spline, which is smooth; beyond the border it keeps the
     * border's values. Fills edge x edge values at the middles of texels, rows from the top; edge
     * is at most KILN_FLUID_FINEST. */
    void (*sample)(const float field[KILN_FLUID_SIZE], uint32_t edge,
                   struct kiln_fluid_scratch *scratch, float *out);
};
KILN_SIMD_DECLARE(const struct kiln_fluid_code, kiln_fluid);

#endif
