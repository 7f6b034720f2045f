/* Declares the forces that move particles. Each kind also has a number in shared/layout.h, a row in
 * shared/forces.h and an option table in options_forces.c. */
#ifndef KILN_SCENE_FORCE_H
#define KILN_SCENE_FORCE_H

#include "shared/layout.h"

enum kiln_force_kind {
    KILN_FORCE_GRAVITY = FORCE_GRAVITY, /* vector: acceleration, m/s^2 */
    KILN_FORCE_DRAG = FORCE_DRAG,       /* drag towards rest: pull, quadratic */
    /* vector: air velocity, m/s, which particles are pulled towards */
    KILN_FORCE_WIND = FORCE_WIND,
    /* curl noise: strength m/s of air velocity, scale m, speed m/s of drift, pull 1/s towards the
     * air, octaves */
    KILN_FORCE_CURL = FORCE_CURL,
    KILN_FORCE_LIMIT = FORCE_LIMIT, /* strength: m/s, limit of the speed */
    KILN_FORCE_FIELD = FORCE_FIELD, /* file: air velocities, m/s; strength: factor; pull 1/s */
    /* vector: a point, m; strength: m/s^2 at 1 m from it, negative to flee; scale: m, radius within
     * which it is softened; falloff */
    KILN_FORCE_ATTRACT = FORCE_ATTRACT,
    /* vector: a point of the axis, m; drift: its direction; strength: m/s at the core's edge;
     * scale: m, radius of the core; inward, lift: m/s; pull 1/s towards the air; profile */
    KILN_FORCE_VORTEX = FORCE_VORTEX,
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

/* The options of all kinds of force; a kind uses some. Each step copies them into struct
 * kiln_force_params (force_at_time in sim/world/params.c), from which kernels read them. */
struct kiln_force {
    enum kiln_force_kind kind;
    struct kiln_value3 vector;
    struct kiln_value strength;
    struct kiln_value pull;      /* 1/s */
    struct kiln_value quadratic; /* 1/m: drag by the square of the speed */
    struct kiln_value scale;     /* m */
    struct kiln_value3 drift;    /* m/s: drift of the noise field */
    struct kiln_value inward;    /* m/s; inward and lift vary over time alone */
    struct kiln_value lift;      /* m/s */
    uint32_t octaves;            /* 1..4 */
    union {                      /* a word of the kind, which kernels know as `profile` */
        enum kiln_falloff falloff;
        enum kiln_vortex_profile profile;
    };
    enum kiln_wind_mode mode; /* how moving air acts */
    const char *file;         /* field: an absolute path (asset/geometry/grid_in.h) */
};

#endif
