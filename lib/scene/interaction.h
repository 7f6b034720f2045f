/* How particles of a system act on each other (UberFlow 2004, 4.3 to 4.5; Drone 2007, 7.4); of each
 * kind at most one a system. */
#ifndef KILN_SCENE_INTERACTION_H
#define KILN_SCENE_INTERACTION_H

#include "shared/value.h"

enum { KILN_MAX_FLOCK = 1 << 20 }; /* slots of a system that flocks */

enum kiln_interaction_kind {
    KILN_INTERACT_COLLIDE, /* with others of the system: shared/interact_collide.h */
    KILN_INTERACT_GRAVITY, /* of each on all others: shared/interact_gravity.h */
    KILN_INTERACT_FLOCK,   /* like birds: shared/interact_flock.h */
};

enum kiln_contact_mode {
    KILN_CONTACT_EXACT,     /* no pair is missed */
    KILN_CONTACT_STAGGERED, /* the paper's: shared/interact_staggered.h */
};

/* How the particles of a flock steer; clock constant or time. */
struct kiln_flock {
    struct kiln_value radius;     /* m: of what one sees; above 0 */
    struct kiln_value view;       /* rad: 0..2 pi, about where it flies */
    struct kiln_value space;      /* m: that each keeps free about itself; above 0 */
    struct kiln_value separation; /* m/s^2: away from who is closer than that */
    struct kiln_value avoidance;  /* m/s^2: out of the way of who is going to be */
    struct kiln_value horizon;    /* s: within so long; above 0 */
    struct kiln_value cohesion;   /* m/s^2 for each metre to the middle of those it sees */
    struct kiln_value alignment;  /* 1/s: towards their mean velocity */
    struct kiln_value all_cohesion, all_alignment; /* the same with the whole system */
    struct kiln_value acceleration;                /* m/s^2: the most of all this together */
    struct kiln_value slowest, fastest;            /* m/s: it flies no slower, no faster */
};

struct kiln_interaction {
    enum kiln_interaction_kind kind;
    enum kiln_contact_mode mode;   /* collide */
    bool as_drawn;                 /* collide: half of look.size times look.scale is the radius */
    struct kiln_value radius;      /* m: collide, of who is not */
    struct kiln_value restitution; /* collide: 0 no bounce .. 1 all energy is kept */
    struct kiln_value apart;       /* collide: 0..1: part of an overlap that a round takes away */
    struct kiln_value fastest;     /* collide: m/s: approach that is foreseen; below 0: auto */
    uint32_t rounds;               /* collide: of pairs in a step */
    bool spins;                    /* collide: they turn, and friction acts on their skin */
    struct kiln_value friction;    /* collide: on each other, of those that turn */
    struct kiln_range turning;     /* collide: rad/s at birth */
    struct kiln_value3 axis;       /* collide: of that; 0: drawn for each particle */
    struct kiln_value rolling;     /* collide: resistance on surfaces, part of what they give */
    struct kiln_value strength;    /* gravity: acceleration at 1 m, m/s^2; below 0 it repels */
    struct kiln_value softening;   /* m: gravity of nearer ones grows no more; above 0 */
    const char *of;                /* gravity: the system that attracts, or "self" */
    bool of_other;                 /* it is another one: */
    uint32_t source;               /* its index */
    struct kiln_flock flock;
};

#endif
