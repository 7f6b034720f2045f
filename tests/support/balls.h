/* Balls that a test places by hand: a system without births, and its records. */
#ifndef KILN_TESTS_BALLS_H
#define KILN_TESTS_BALLS_H

#include "support/scene_fixture.h"
#include "support/simulation.h"

enum { BALLS_FIRST_STEP = 1 }; /* that the balls are placed after */

/* `count` balls of a radius in metres that keep all energy; no forces, no colliders. */
struct kiln_interaction *balls_init(struct scene_fixture *f, uint32_t count, float radius);

void balls_place(struct simulation *run, uint32_t slot, float3 position, float3 velocity);

/* The same numbers in every run: -1 to 1. */
float balls_random(uint32_t *seed);

/* What is kept: sums in double, by the masses of balls of one material. */
struct balls_sums {
    double mass, momentum[3], energy;
};

struct balls_sums balls_sum(struct simulation *run, uint32_t count,
                            double (*mass)(uint32_t serial));

#endif
