/* Declares functions that compute how many particles are born in each step, and when in the step.
 * It is integer arithmetic on the host, the same on every machine. A rate is integrated in fixed
 * point, and a particle is born whenever the integral passes a whole number: at 5 a second, births
 * are exactly 0.2 s apart, the first one at the start of the run. */
#ifndef KILN_PARTICLES_BIRTHS_H
#define KILN_PARTICLES_BIRTHS_H

#include <stdbool.h>
#include <stdint.h>

#include "shared/layout.h"

/* Particles that are born at one time, or again and again. Each repetition draws its number of
 * particles, uniformly, and its delay from the key of the source. */
struct kiln_burst {
    double time_s;     /* clip time of the first one */
    uint32_t count[2]; /* the fewest and the most particles of a repetition */
    double every_s;    /* from one repetition to the next; 0: the burst is not repeated */
    uint32_t most;     /* the most repetitions, the first one included, if it is repeated */
    double jitter_s;   /* each is up to this later; at most every_s if the burst is repeated */
};

/* Holds everything that determines the births of a system. Step k = 1, 2, ... lasts from (k - 1 -
 * warmup_steps) to (k - warmup_steps) times steps_den / steps_num seconds of clip time. */
struct kiln_births_source {
    /* returns the particles born a second, at a clip time */
    float (*rate)(const void *context, float time_s);
    const void *context;
    const struct kiln_burst *bursts;
    uint32_t burst_count;          /* at most KILN_MAX_BURSTS */
    uint32_t random_key;           /* that of the system, by which bursts draw */
    uint32_t steps_num, steps_den; /* steps a second, as a fraction; not zero */
    uint32_t warmup_steps;
    /* births by the way of the emitter: their number by the end of each step, from step 0 on, in
     * 2^-32 births, or NULL; and how many numbers there are */
    const uint64_t *by_way;
    uint32_t way_count;
};

/* Lists the births of one step in order of their serials: first the births of the rate, then those
 * of the way, then those of each burst and each of its repetitions in the step. */
struct kiln_births {
    uint32_t count;
    uint32_t steady;        /* births of the rate and of the way */
    uint32_t steady_groups; /* the first groups, in which these are: at most 2 */
    bool left_out; /* the step has more than KILN_MAX_BURSTS bursts; those beyond are left out */
    uint32_t group_count;
    struct kiln_birth_group groups[KILN_MAX_BIRTH_GROUPS];
};

/* Computes the births of step number `step`. The caller must ask for the steps in order. *wait must
 * be 0 before step 1 and be passed on to the next step; it is the part of the integral that the
 * next birth still lacks. The rate is evaluated at the middle of the step, which is exact where the
 * rate is linear. A rate that is negative or NaN counts as 0, and a rate above 2^31 as 2^31. A
 * burst happens at the nearest 64th of a step. */
void kiln_births_step(const struct kiln_births_source *source, uint32_t step, uint64_t *wait,
                      struct kiln_births *births);

/* Returns the number of steps after its birth step at whose end a particle is dead at the latest,
 * wherever in that step it was born; at most `steps`. */
uint32_t kiln_births_lifespan(float longest_life_s, float dt_s, uint32_t steps);

struct kiln_births_bound {
    uint64_t capacity; /* the most births in any lifespan + 1 consecutive steps */
    uint64_t total;    /* number of births of all steps */
    uint32_t crowded;  /* the first step that has more than KILN_MAX_BURSTS bursts, or 0 */
};

/* Bounds the births of steps 1 to `steps`. If serial s takes slot s mod capacity, `capacity` slots
 * are enough for each birth to find its slot free. Serials reach `total`, which must fit 32 bits.
 * lifespan: that of a particle and all its descendants, in steps. */
struct kiln_births_bound kiln_births_bound(const struct kiln_births_source *source, uint32_t steps,
                                           uint32_t lifespan);

#endif
