/* Steps a domain of gas by constants that a test chooses, without a scene, and measures what is in
 * it. Tests of the solver compare these measures with closed forms. */
#ifndef KILN_TESTS_GAS_RIG_H
#define KILN_TESTS_GAS_RIG_H

#include "sim/gas/solver.h"

struct gas_rig {
    struct kiln_threads *threads;
    struct kiln_gas gas;
    struct gas_solver solver;
    struct kiln_gas_step step; /* the test may change it between steps */
    uint32_t cycles;           /* of the pressure in a step: 2 */
    double residual;           /* that is asked for: 0 */
};

/* Returns the constants of a step in which gas moves, and nothing else happens to it. */
struct kiln_gas_step gas_rig_constants(float cell, float dt);

/* Makes a domain with no gas in it, whose window is all of it and whose bricks are all active. The
 * caller ends it. simd: level of vectors. */
void gas_rig_start(struct gas_rig *rig, const struct kiln_gas_shape *shape, float dt,
                   enum kiln_simd simd, uint32_t threads);
void gas_rig_end(struct gas_rig *rig);

/* Runs steps in which all bricks are active. A failure fails the test. */
void gas_rig_run(struct gas_rig *rig, uint32_t steps);

/* Returns the four floats of a cell of the window, NULL if its brick is idle. */
float *gas_cell(const struct kiln_gas *gas, int32_t x, int32_t y, int32_t z);

/* Returns a quantity of a cell of the domain: 0 where there is no gas. */
float gas_at(const struct kiln_gas *gas, int quantity, int32_t x, int32_t y, int32_t z);

/* Returns the sum of a quantity over all cells, and the mean place of it, in m. */
double gas_sum(const struct kiln_gas *gas, int quantity);
void gas_center(const struct kiln_gas *gas, int quantity, double center[3]);

/* Returns the sum over cells of the square of the velocity, (m/s)^2. */
double gas_energy(const struct kiln_gas *gas);

/* Returns the largest velocity across a face of the window, m/s. */
double gas_fastest(const struct kiln_gas *gas);

/* Returns the root of the mean square of the divergence over the window's cells, 1/s. */
double gas_divergence(const struct kiln_gas *gas);

#endif
