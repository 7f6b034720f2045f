/* Holds a block of slots while slots_simd.c steps it, and declares what finishes slots that are
 * stepped alone (slots_alone.c). */
#ifndef KILN_SIM_STEP_SLOTS_BLOCK_H
#define KILN_SIM_STEP_SLOTS_BLOCK_H

#include "particles/lanes.h"
#include "sim/step/slots.h"

/* Holds struct stages for each lane. */
struct stages_lanes {
    struct kiln_floats3 position, velocity, at, moving, acceleration, first, early, changed, flown;
    kiln_floats pull, quadratic, fastest, trust;
};

/* Why a lane is stepped alone, and not with its block. */
enum alone {
    ALONE_NOT,
    ALONE_TOUCHES, /* it may have met a collider on its way */
    ALONE_BORN,    /* it is born in this step */
    ALONE_LEAVES,  /* its life ends, and it leaves a trace */
};

struct kiln_block {
    struct kiln_lanes lanes;
    uint32_t born[KILN_LANES];        /* 1: a particle is born in the slot in this step */
    uint32_t alone[KILN_LANES];       /* one of enum alone */
    uint32_t touching[KILN_LANES];    /* 1: the lane may touch the present collider */
    uint32_t lost[KILN_LANES];        /* 1: the particle is in a place where it dies */
    kiln_floats life, age_s;          /* progress of life, and age, at the start of the step */
    struct kiln_lane_clocks clocks;   /* of the values of the forces */
    struct kiln_floats3 start;        /* velocity at the start, pushes included */
    kiln_floats radius;               /* of particles with pushes */
    struct kiln_floats3 at;           /* where the forces are evaluated */
    struct kiln_floats3 acceleration; /* sum of the forces so far */
    kiln_floats pull, quadratic;
    struct kiln_floats3 velocity, position; /* at the end of the step */
    struct kiln_floats3 vector, second;     /* options of the present force */
    kiln_floats strength, pulling, braking, scale;
    struct kiln_floats3 kept_acceleration; /* sum of the forces before one that stands apart */
    kiln_floats kept_pull, kept_quadratic;
    struct kiln_floats3 kept_at; /* places in the world, while a force in a node is evaluated */
    struct kiln_floats3 place, curl;
    uint32_t sample[KILN_LANES]; /* index of the first sample around a place in a grid */
    struct stages_lanes stages;
    struct kiln_floats3 rate; /* spin of particles that collide as balls */
    kiln_floats pose[4];
};

static inline struct kiln_particle record_at(const struct kiln_block *b, uint32_t i)
{
    return kiln_lanes_record(&b->lanes, i);
}

/* Returns whether particles are born of others. */
static inline bool kiln_slots_are_children(const struct kiln_slots *slots)
{
    return slots->sim.step->family.born_of != BORN_OF_CLOCK;
}

/* Returns the trace of the parent of a slot's child. */
static inline const struct kiln_trace *kiln_slots_parent(const struct kiln_slots *slots,
                                                         uint32_t slot)
{
    return &slots->traces[family_parent_trace(&slots->sim, slot)];
}

/* Fetches the cells that the births of a block will choose into the cache, if they are born on a
 * mesh or an image. */
void kiln_slots_fetch(const struct kiln_sim *sim, uint32_t first_slot, const struct kiln_block *b);

/* Finishes the step of lane i, whose block has been stepped: writes the record of `slot`, and its
 * trace if the system leaves traces. before: the record before the step. */
void kiln_slots_finish(const struct kiln_slots *slots, const struct kiln_block *b, uint32_t i,
                       uint32_t slot, struct kiln_particle before);

#endif
