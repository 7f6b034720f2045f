/* How many particles are born in each step, and when in the step: integer arithmetic on the host,
 * the same on every machine. A rate is integrated in fixed point, so births lie where the integral
 * of the rate passes a whole number: 5 a second are born exactly every 0.2 s, the first one at the
 * start of the run.
 */
#ifndef KILN_PARTICLES_BIRTHS_H
#define KILN_PARTICLES_BIRTHS_H

#include <stdbool.h>
#include <stdint.h>

#include "shared/layout.h"

/* Particles born at one time. */
struct kiln_burst {
    double time_s; /* clip time */
    uint32_t count;
};

/* What a system's births follow from. Step k = 1, 2, ... lasts from (k - 1 - warmup_steps) to
 * (k - warmup_steps) times steps_den / steps_num seconds of clip time. */
struct kiln_births_source {
    float (*rate)(const void *context, float time_s); /* particles a second, at a clip time */
    const void *context;
    const struct kiln_burst *bursts; /* ascending in time */
    uint32_t burst_count;            /* below KILN_MAX_BIRTH_GROUPS */
    uint32_t steps_num, steps_den;   /* steps a second; not zero */
    uint32_t warmup_steps;
};

/* The births of one step, in order of their serials: the rate's, then each burst's. */
struct kiln_births {
    uint32_t count;
    uint32_t group_count;
    struct kiln_birth_group groups[KILN_MAX_BIRTH_GROUPS];
};

/* The births of step number `step`; steps must be asked for in order, and *wait, 0 before step 1,
 * carried along: it is what the next birth still waits for. The rate is taken at the middle of the
 * step (exact while the rate is linear in it) and counts as 0 when it is negative or not finite, as
 * 2^31 beyond that. A burst counts at the nearest 64th of a step. */
void kiln_births_step(const struct kiln_births_source *source, uint32_t step, uint64_t *wait,
                      struct kiln_births *births);

/* Steps after its birth step by whose end a particle is dead, wherever in that step it was born; at
 * most `steps`. */
uint32_t kiln_births_lifespan(float longest_life_s, float dt_s, uint32_t steps);

struct kiln_births_bound {
    uint64_t capacity; /* the most births in any lifespan + 1 steps on end */
    uint64_t total;    /* births of all steps */
};

/* What steps 1 .. steps will need: a system with `capacity` slots has a free one for each birth
 * when serial s takes slot s mod capacity, and serials reach `total`, which must fit 32 bits. The
 * lifespan is that of a particle and all that descends from it. */
struct kiln_births_bound kiln_births_bound(const struct kiln_births_source *source, uint32_t steps,
                                           uint32_t lifespan);

#endif
