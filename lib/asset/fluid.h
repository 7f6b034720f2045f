/* A small two-dimensional fluid, which carries the gas of the procedural flipbooks. The same bits
 * on every machine: nothing but IEEE arithmetic in a fixed order. */
#ifndef KILN_ASSET_FLUID_H
#define KILN_ASSET_FLUID_H

#include <stdint.h>

enum {
    KILN_FLUID_EDGE = 64, /* samples a side */
    KILN_FLUID_SIZE = KILN_FLUID_EDGE * KILN_FLUID_EDGE,
};

/* Samples lie at the middles of squares that tile [-1, 1]^2, rows from the bottom. A unit of length
 * is half the edge of a flipbook's cell, a unit of time what the caller's dt says. */
struct kiln_fluid {
    float vorticity[KILN_FLUID_SIZE];
    float stream[KILN_FLUID_SIZE]; /* whose curl the velocity is: it has no divergence */
    float velocity_x[KILN_FLUID_SIZE], velocity_y[KILN_FLUID_SIZE];
    float heat[KILN_FLUID_SIZE];    /* rises by buoyancy */
    float place_x[KILN_FLUID_SIZE]; /* where the gas was at its start: detail that is a function */
    float place_y[KILN_FLUID_SIZE]; /* of it is carried along without being blurred */
    float buoyancy;                 /* acceleration where heat is 1 */
    float swelling;                 /* relative growth of lengths a unit of time, about (0, 0) */
    float strain;                   /* likewise: growth of heights, and loss of widths */
    float rise;                     /* speed at which everything rises besides */
    float drag;                     /* part of the vorticity lost a unit of time */
    float scratch[4][KILN_FLUID_SIZE];
};

/* The coordinate of a column or row. */
static inline float kiln_fluid_at(uint32_t index)
{
    return ((float)index + 0.5f) * (2.0f / KILN_FLUID_EDGE) - 1.0f;
}

/* At rest and cold, every place its own. */
void kiln_fluid_init(struct kiln_fluid *fluid);

/* One step: buoyancy turns, the velocity follows from the turning (walls at the sides, open below
 * and above), and everything moves with it. */
void kiln_fluid_step(struct kiln_fluid *fluid, float dt);

/* A field between its samples, held at the border; smooth (a quadratic B-spline). */
float kiln_fluid_sample(const float field[KILN_FLUID_SIZE], float x, float y);

#endif
