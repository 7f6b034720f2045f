/* Declares the parameters of one system for the computation of its pushes, laid out alike in C and
 * in a std140 block, and the scratch memory: bodies, which are the living particles of the system
 * in order of their cells.
 *
 * In GLSL the functions read these as globals, in C through pointers. CROWD_PARAM and CROWD pass
 * them on, and CROWD_KEYS is their VALUE_KEYS. INTERACT(x), BODY(i), CELL_END(cell) and PARTNER(i)
 * name them; TURNING(i) has the words of a body's spin (shared/spin.h). */
#ifndef KILN_SHARED_INTERACT_LAYOUT_H
#define KILN_SHARED_INTERACT_LAYOUT_H

#include "shared/layout.h"
#include "shared/particle.h"

/* Values that stand for no partner: the body touches no other at the start of the step and takes no
 * part in the rounds; or it has no partner in this round. */
#define INTERACT_NOBODY     0xffffffffu
#define INTERACT_NOBODY_NOW 0xfffffffeu

/* Parameters of a flock, at the time of the step. */
struct kiln_flock_params {
    float radius, radius_square; /* m, m^2: others within it may be seen */
    float per_radius;            /* 1/m */
    float per_space;             /* 1/m: reciprocal of the distance that is kept free */
    float speed, per_speed;      /* m/s, s/m: differences of velocity that count in full */
    float horizon_s, per_horizon;
    float view;                     /* as in flock_sees */
    float separation;               /* m/s^2 */
    float avoidance;                /* m/s^2 */
    float cohesion, all_cohesion;   /* 1/s^2 */
    float alignment, all_alignment; /* 1/s */
    float strongest;                /* m/s^2: limit of the sum of all */
    float slowest, fastest;         /* m/s */
    uint looks;                     /* 1: neighbours are looked at */
    uint unused;
};

struct kiln_interact_params {
    S(kiln_derived_params) derived;
    uint base;       /* the system's first slot in the record buffer */
    uint used;       /* slots that may hold a particle */
    uint first_push; /* first slot of the system in the buffer of pushes */
    uint step;       /* the step after which the state is */
    uint cell_mask;  /* cells of the table, a power of two, less 1 */
    uint as_drawn;   /* 1: radii are those of the look */
    float time_s;    /* clip time of the state */
    float cells_per_metre;
    float restitution;
    float apart;            /* part of an overlap that is removed in a round */
    float softening_square; /* m^2 */
    uint adds;              /* 1: gravity or a flock adds to pushes that exist already */
    S(kiln_value) radius;   /* m */
    S(kiln_value) size;     /* m: of the look, twice the radius */
    S(kiln_range) scale;    /* factor on size, random for each particle */
    S(kiln_value) strength; /* of gravity: m/s^2 at 1 m */
    S(kiln_flock_params) flock;
    float ahead_s;        /* s: how far ahead collisions are searched */
    float fastest_square; /* m^2/s^2: pairs with a faster approach are not searched ahead */
    uint spins;           /* 1: balls spin, and spins follow all bodies: TURNING(i) */
    uint first_spin;      /* first slot of the system in the buffer of spins */
    float friction;       /* friction between two balls that spin */
    uint unused0, unused1, unused2;
};

struct kiln_body {
    uint4 position_radius; /* float bits, metres */
    uint4 velocity_slot;   /* float bits, metres a second; slot of the system */
};

#ifdef GL_core_profile
#define CROWD
#define CROWD_PARAM
#define CROWD_KEYS
#define INTERACT(x)    interact_params.x
#define BODY(i)        bodies[i]
#define TURNING(i)     bodies[interact_params.used + (i)].position_radius
#define CELL_END(cell) cell_ends[cell]
#define PARTNER(i)     partners[i]
#else
struct kiln_crowd {
    const struct kiln_interact_params *params;
    const float4 *value_keys;
    const struct kiln_body *bodies;
    const uint *cell_ends; /* index behind the last body of each cell */
    const uint *partners;
    const uint *order; /* a second order of the bodies, for ways to find partners that need one */
};
#define CROWD          crowd,
#define CROWD_PARAM    const struct kiln_crowd *crowd,
#define CROWD_KEYS     crowd->value_keys,
#define INTERACT(x)    crowd->params->x
#define BODY(i)        crowd->bodies[i]
#define TURNING(i)     crowd->bodies[crowd->params->used + (i)].position_radius
#define CELL_END(cell) crowd->cell_ends[cell]
#define PARTNER(i)     crowd->partners[i]
#endif

#endif
