/* Makes a scene with one system of balls for tests of interactions between particles. The system
 * emits nothing. Instead, a test places each ball by balls_place, so that it knows the ball's exact
 * position and velocity at the start. */
#ifndef KILN_TESTS_BALLS_H
#define KILN_TESTS_BALLS_H

#include "support/scene_fixture.h"
#include "support/simulation.h"

enum { BALLS_FIRST_STEP = 1 }; /* the step at whose end balls are placed */

/* Makes a scene with one system, which has slots for `count` balls. radius: of each ball, m. The
 * balls collide with each other without losing energy; there are no forces and no colliders. Before
 * the first call, *f must be all zeros. Returns the collision interaction, which a test may change.
 */
struct kiln_interaction *balls_init(struct scene_fixture *f, uint32_t count, float radius);

/* Puts a living ball into a slot, and sets the run to the end of step BALLS_FIRST_STEP. position:
 * of its centre, m; velocity: m/s. */
void balls_place(struct simulation *run, uint32_t slot, float3 position, float3 velocity);

/* Returns a pseudo-random number from -1 to 1 and changes the seed. Equal seeds give equal
 * sequences. */
float balls_random(uint32_t *seed);

/* Total mass, momentum and kinetic energy of living balls, in double precision. Elastic collisions
 * conserve all three. */
struct balls_sums {
    double mass, momentum[3], energy; /* kg, kg m/s, J (kinetic), for masses in kg */
};

/* Sums up the living balls in slots 0 to count - 1. mass: returns a ball's mass by its serial,
 * which equals its slot; if it is NULL, each ball has mass 1. */
struct balls_sums balls_sum(struct simulation *run, uint32_t count,
                            double (*mass)(uint32_t serial));

#endif
