/* A small two-dimensional fluid, which carries the gas of the procedural flipbooks. The same bits
 * on every machine: nothing but IEEE arithmetic in a fixed order. */
#ifndef KILN_ASSET_ATLAS_FLUID_H
#define KILN_ASSET_ATLAS_FLUID_H

#include <stdalign.h>
#include <stdint.h>

#include "base/simd.h"

enum {
    KILN_FLUID_EDGE = 64, /* samples a side */
    KILN_FLUID_SIZE = KILN_FLUID_EDGE * KILN_FLUID_EDGE,
    KILN_FLUID_DIAGONALS = 2 * KILN_FLUID_EDGE - 1,
    KILN_FLUID_MARGIN = 16,                                 /* floats before a diagonal */
    KILN_FLUID_PITCH = KILN_FLUID_MARGIN + KILN_FLUID_EDGE, /* from one to the next */
    KILN_FLUID_FINEST = 128,                                /* texels a side */
};

/* Samples lie at the middles of squares that tile [-1, 1]^2, rows from the bottom. A unit of length
 * is half the edge of a flipbook's cell, a unit of time what the caller's dt says. */
struct kiln_fluid {
    float vorticity[KILN_FLUID_SIZE];
    /* The function whose curl the velocity is, so that it has no divergence, and the vorticity once
     * more: rows are the diagonals on which x + y is the same, columns are x. */
    alignas(64) float stream[KILN_FLUID_DIAGONALS + 2][KILN_FLUID_PITCH];
    alignas(64) float turning[KILN_FLUID_DIAGONALS][KILN_FLUID_EDGE];
    float velocity_x[KILN_FLUID_SIZE], velocity_y[KILN_FLUID_SIZE];
    float heat[KILN_FLUID_SIZE];    /* rises by buoyancy */
    float place_x[KILN_FLUID_SIZE]; /* where the gas was at its start: detail that is a function */
    float place_y[KILN_FLUID_SIZE]; /* of it is carried along without being blurred */
    float buoyancy;                 /* acceleration where heat is 1 */
    float swelling;                 /* relative growth of lengths a unit of time, about (0, 0) */
    float strain;                   /* likewise: growth of heights, and loss of widths */
    float rise;                     /* speed at which everything rises besides */
    float drag;                     /* part of the vorticity lost a unit of time */
};

/* The coordinate of a column or row. */
static inline float kiln_fluid_at(uint32_t index)
{
    return ((float)index + 0.5f) * (2.0f / KILN_FLUID_EDGE) - 1.0f;
}

/* At rest and cold, every place its own. */
void kiln_fluid_init(struct kiln_fluid *fluid);

/* Room for sampling. */
struct kiln_fluid_room {
    float columns[KILN_FLUID_EDGE][3][KILN_FLUID_FINEST];
};

struct kiln_fluid_code {
    /* One step: buoyancy turns, the velocity follows from the turning (walls at the sides, open
     * below and above), and everything moves with it. */
    void (*step)(struct kiln_fluid *fluid, float dt);
    /* A field between its samples, held at the border; smooth (a quadratic B-spline). Fills edge x
     * edge values at the middles of texels, rows from the top; edge is at most KILN_FLUID_FINEST.
     */
    void (*sample)(const float field[KILN_FLUID_SIZE], uint32_t edge, struct kiln_fluid_room *room,
                   float *out);
};
KILN_SIMD_DECLARE(const struct kiln_fluid_code, kiln_fluid);

#endif
