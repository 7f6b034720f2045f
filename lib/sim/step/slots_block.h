/* Holds a block of slots while slots_simd.c steps it. */
#ifndef KILN_SIM_STEP_SLOTS_BLOCK_H
#define KILN_SIM_STEP_SLOTS_BLOCK_H

#include "particles/lanes.h"
#include "sim/step/slots.h"

/* struct stages of each lane. */
struct stages_lanes {
    struct kiln_floats3 position, velocity, at, moving, acceleration, first, early, changed, flown;
    kiln_floats pull, quadratic, fastest, trust;
};

/* Who is not stepped with the others. */
enum alone {
    ALONE_NOT,
    ALONE_TOUCHES, /* may have met something on the way that it has flown */
    ALONE_BORN,    /* a case for step_slot */
};

struct block {
    struct kiln_lanes lanes;
    uint32_t alone[KILN_LANES];       /* enum alone */
    uint32_t touching[KILN_LANES];    /* 1: may touch the collider at hand */
    uint32_t lost[KILN_LANES];        /* 1: where particles may not be */
    kiln_floats life;                 /* progress at the start of the step */
    struct kiln_floats3 start;        /* velocity at the start, pushes included */
    kiln_floats radius;               /* of those that are pushed */
    struct kiln_floats3 at;           /* where the forces are looked up */
    struct kiln_floats3 acceleration; /* of the forces so far */
    kiln_floats pull, quadratic;
    struct kiln_floats3 velocity, position; /* at the end */
    struct kiln_floats3 vector, drift;      /* options of a force */
    kiln_floats strength, pulling, braking, scale;
    struct kiln_floats3 place, curl;
    struct stages_lanes stages;
    struct kiln_floats3 rate; /* of balls that turn */
    kiln_floats pose[4];
};

static inline struct kiln_particle record_at(const struct block *b, uint32_t i)
{
    return kiln_lanes_record(&b->lanes, i);
}

#endif
