/* Declares the forces that move particles. Each kind also has a number in shared/layout.h, a row in
 * shared/forces.h and an option table in options_forces.c. */
#ifndef KILN_SCENE_FORCE_H
#define KILN_SCENE_FORCE_H

#include <stdbool.h>

#include "scene/node.h"
#include "shared/layout.h"

enum kiln_force_kind {
    /* the air of a domain of gas, at the points of a grid: kernels know it as FORCE_BAKED, and no
     * force by this number */
    KILN_FORCE_GAS = 29,
    KILN_FORCE_GRAVITY = FORCE_GRAVITY, /* the same acceleration everywhere */
    KILN_FORCE_DRAG = FORCE_DRAG,       /* drag towards rest: pull, quadratic */
    KILN_FORCE_WIND = FORCE_WIND,   /* air of one velocity, which particles are pulled towards */
    KILN_FORCE_CURL = FORCE_CURL,   /* air that moves as curl noise */
    KILN_FORCE_LIMIT = FORCE_LIMIT, /* a limit of the speed */
    KILN_FORCE_FIELD = FORCE_FIELD, /* air velocities of a file */
    KILN_FORCE_ATTRACT = FORCE_ATTRACT, /* a point that attracts, or repels */
    KILN_FORCE_VORTEX = FORCE_VORTEX,   /* air that turns around an axis */
    KILN_FORCE_BAKED = FORCE_BAKED,     /* the sum of other forces, at the points of a grid */
};

enum kiln_falloff {
    KILN_FALLOFF_INVERSE_SQUARE = FALLOFF_INVERSE_SQUARE,
    KILN_FALLOFF_INVERSE = FALLOFF_INVERSE,
    KILN_FALLOFF_CONSTANT = FALLOFF_CONSTANT,
    KILN_FALLOFF_LINEAR = FALLOFF_LINEAR,
};

enum kiln_vortex_profile {
    KILN_VORTEX_RANKINE = VORTEX_RANKINE,
    KILN_VORTEX_LAMB_OSEEN = VORTEX_LAMB_OSEEN,
};

/* How moving air acts on particles. */
enum kiln_wind_mode {
    KILN_WIND_PULL, /* (air - velocity) * pull, as an acceleration */
    KILN_WIND_ADD,  /* the air's velocity is added in each step (UberFlow 2004, 4.2); no pull */
};

/* A box or a ball in which a force acts. Its values vary over time alone. */
struct kiln_force_region {
    bool enabled;                  /* false: everywhere */
    bool box, sphere;              /* one of them, where it is enabled */
    struct kiln_value3 box_center; /* m */
    struct kiln_value3 box_size;   /* m: full edges */
    struct kiln_value3 ball_center;
    struct kiln_value radius;  /* m: of the ball */
    struct kiln_value falloff; /* m: over which the force fades, inside of the border */
    struct kiln_attach attach; /* the region lies in this node; no name: in that of the force */
};

struct kiln_force;

/* Forces that a baked wind sums up. */
struct kiln_baked_forces {
    struct kiln_force *at; /* the scene's arena owns them */
    uint32_t count;        /* 1..KILN_MAX_BAKED_OF */
};

/* The options of all kinds of force; a kind uses some. In a union, the first member is the name
 * that kernels know, and the others are the same memory by the names of kinds. Each step copies all
 * options into struct kiln_force_params (sim/world/force_params.c), from which kernels
 * read them. */
struct kiln_force {
    enum kiln_force_kind kind;
    struct kiln_attach attach; /* the force, and its region, lie in this node */
    union {
        struct kiln_value3 vector;
        struct kiln_value3 acceleration; /* gravity: m/s^2 */
        struct kiln_value3 air;          /* wind: velocity, m/s */
        struct kiln_value3 center;       /* attract: the point; vortex: a point of the axis; m */
        struct kiln_value3 box_center;   /* baked, gas: of the box, m: constant */
    };
    union {
        struct kiln_value3 second;
        struct kiln_value3 drift;    /* curl: velocity of the noise field, m/s */
        struct kiln_value3 axis;     /* vortex: its direction, of any length */
        struct kiln_value3 box_size; /* baked, gas: edges of the box, m: constant */
    };
    union {
        /* curl: velocity of the air, m/s; field: a factor; attract: acceleration at 1 m, m/s^2,
         * negative to repel */
        struct kiln_value strength;
        struct kiln_value speed; /* limit; vortex: of the air at the core's edge; m/s */
    };
    struct kiln_value pull;      /* towards the air, 1/s */
    struct kiln_value quadratic; /* drag by the square of the speed, 1/m */
    union {
        struct kiln_value scale;  /* curl: size of the largest eddies, m */
        struct kiln_value radius; /* attract: of the softening; vortex: of the core; m */
    };
    struct kiln_value inward; /* vortex: m/s; inward and lift vary over time alone */
    struct kiln_value lift;   /* vortex: m/s */
    uint32_t octaves;         /* 1..4 */
    union {                   /* a word of the kind, which kernels know as `profile` */
        enum kiln_falloff falloff;
        enum kiln_vortex_profile profile;
    };
    enum kiln_wind_mode mode; /* how moving air acts */
    struct kiln_force_region region;
    const char *file;            /* field: an absolute path (asset/geometry/grid_in.h) */
    uint32_t cells;              /* baked, gas: along the longest edge of the box */
    uint32_t every;              /* baked: steps from one writing to the next */
    struct kiln_baked_forces of; /* baked */
    /* gas: the name of a domain; its number, box_center, box_size, attach and every follow */
    const char *gas;
    uint32_t domain;
};

/* Returns whether what a force does is written to the points of a grid in a box. */
static inline bool kiln_force_is_baked(const struct kiln_force *force)
{
    return force->kind == KILN_FORCE_BAKED || force->kind == KILN_FORCE_GAS;
}

/* Returns the number by which kernels know the kind of a force: FORCE_BAKED for gas, too. */
static inline uint kiln_force_number(const struct kiln_force *force)
{
    return kiln_force_is_baked(force) ? FORCE_BAKED : (uint)force->kind;
}

#endif
