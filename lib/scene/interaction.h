/* Declares how particles of a system act on each other (UberFlow 2004, 4.3 to 4.5; Drone 2007,
 * 7.4). A system has at most one interaction of each kind. */
#ifndef KILN_SCENE_INTERACTION_H
#define KILN_SCENE_INTERACTION_H

#include "shared/value.h"

enum { KILN_MAX_FLOCK = 1 << 20 }; /* The most slots of a system that flocks. */

enum kiln_interaction_kind {
    /* collision with the system's other particles: shared/interact_collide.h */
    KILN_INTERACT_COLLIDE,
    KILN_INTERACT_GRAVITY, /* attraction of all by all: shared/interact_gravity.h */
    KILN_INTERACT_FLOCK,   /* flocking, as birds do: shared/interact_flock.h */
};

enum kiln_contact_mode {
    KILN_CONTACT_EXACT,     /* finds every pair that touches */
    KILN_CONTACT_STAGGERED, /* finds pairs as the paper does: shared/papers/interact_staggered.h */
    KILN_CONTACT_MODES
};

/* How the particles of a flock steer. Values have the clock constant or time. */
struct kiln_flock {
    struct kiln_value radius; /* m: radius within which a particle sees others; above 0 */
    struct kiln_value view;   /* rad: 0..2 pi, angle of view about the direction of flight */
    /* m: distance that a particle keeps free around itself; above 0 */
    struct kiln_value space;
    struct kiln_value separation; /* m/s^2: acceleration away from others closer than `space` */
    /* m/s^2: acceleration away from others that will be closer soon */
    struct kiln_value avoidance;
    struct kiln_value horizon;   /* s: how far ahead `avoidance` looks; above 0 */
    struct kiln_value cohesion;  /* m/s^2 for each metre to the middle of the others in view */
    struct kiln_value alignment; /* 1/s: pull towards the mean velocity of the others in view */
    /* cohesion and alignment with the whole system */
    struct kiln_value all_cohesion, all_alignment;
    /* m/s^2: limit of the sum of all these accelerations */
    struct kiln_value acceleration;
    struct kiln_value slowest, fastest; /* m/s: limits of the speed */
};

struct kiln_interaction {
    enum kiln_interaction_kind kind;
    enum kiln_contact_mode mode;   /* collide */
    bool as_drawn;                 /* collide: the radius is half of look.size times look.scale */
    struct kiln_value radius;      /* m: collide, unless as_drawn */
    struct kiln_value restitution; /* collide: 0 no bounce .. 1 all energy is kept */
    struct kiln_value apart;       /* collide: 0..1, the part of an overlap that a round removes */
    /* collide: m/s, the fastest approach that the search allows for; below 0: auto */
    struct kiln_value fastest;
    uint32_t rounds; /* collide: rounds of collisions in a step */
    /* collide: particles turn, and friction acts on their surfaces */
    bool spins;
    struct kiln_value friction; /* collide: friction between particles that spin */
    struct kiln_range turning;  /* collide: rad/s, angular speed at birth */
    struct kiln_value3 axis;    /* collide: axis of that rotation; 0: random for each particle */
    struct kiln_value rolling;  /* collide: lever arm of rolling resistance, in radii */
    struct kiln_value strength; /* gravity: acceleration at 1 m, m/s^2; below 0 it repels */
    /* m: gravity softening; within it the attraction does not grow; above 0 */
    struct kiln_value softening;
    const char *of;  /* gravity: the system that attracts, or "self" */
    bool of_other;   /* `of` names another system: */
    uint32_t source; /* index of that system */
    struct kiln_flock flock;
};

#endif
