/* Makes balls that a test places by hand: a system without births, and its records. */
#ifndef KILN_TESTS_BALLS_H
#define KILN_TESTS_BALLS_H

#include "support/scene_fixture.h"
#include "support/simulation.h"

enum { BALLS_FIRST_STEP = 1 }; /* the step after which the balls are placed */

/* Makes a scene with a system for `count` balls of a radius, m, whose collisions keep all energy.
 * It has no forces and no colliders. Returns the interaction, which a test may change. */
struct kiln_interaction *balls_init(struct scene_fixture *f, uint32_t count, float radius);

/* Puts a living ball into a slot, and the run at BALLS_FIRST_STEP. */
void balls_place(struct simulation *run, uint32_t slot, float3 position, float3 velocity);

/* Returns a random number from -1 to 1, the same sequence for the same seed. */
float balls_random(uint32_t *seed);

/* Sums over living balls, in double: the quantities that collisions keep. */
struct balls_sums {
    double mass, momentum[3], energy;
};

/* Sums up the balls in slots 0 to count - 1. mass: the mass of a ball by its slot; NULL: 1. */
struct balls_sums balls_sum(struct simulation *run, uint32_t count,
                            double (*mass)(uint32_t serial));

#endif
