/* Declares domains of gas: boxes in which smoke and fire flow (Heinz 2019, 2.3.2). sim/gas steps
 * them. Lengths are in the node that a domain is attached to. */
#ifndef KILN_SCENE_GAS_H
#define KILN_SCENE_GAS_H

#include "particles/gas.h"
#include "scene/emitter.h"
#include "scene/force.h"

enum {
    KILN_MAX_GAS_SOURCES = 8, /* of a domain */
    KILN_MAX_SUBSTEPS = 16,
    KILN_MAX_GAS_CELLS = 1 << 28, /* of all domains of a scene */
    KILN_GAS_LIGHTS = 4,          /* of the flames of a domain: lights on what is around it */
};

/* Number of a domain among those of the systems, for what evaluates values by the number of a
 * system (kiln_scene_clocks): noise in a domain differs from that of systems and other domains. */
#define KILN_SYSTEM_OF_GAS(domain) (KILN_MAX_SYSTEMS + (domain))

/* Says which pixels have a ray through a domain. */
enum kiln_gas_resolution {
    KILN_GAS_FULL, /* all */
    KILN_GAS_HALF, /* every second one of every second row, and where light or the scene changes */
};

/* What a domain has on one of its sides. */
enum kiln_gas_side {
    KILN_SIDE_OPEN,   /* gas and air flow through it */
    KILN_SIDE_CLOSED, /* a wall */
};

enum kiln_gas_from {
    KILN_GAS_FROM_SHAPE,  /* a shape of emit.from */
    KILN_GAS_FROM_SYSTEM, /* the particles of a system */
};

/* Brings the gas at a place towards values of its own, with a rate. Values have the clock constant
 * or time. */
struct kiln_gas_source {
    enum kiln_gas_from from;  /* follows from emit.shape */
    struct kiln_emitter emit; /* shape: the members of the shape, and attach */
    const char *system_name;  /* system */
    uint32_t system;          /* follows: its number */
    struct kiln_value reach;  /* m: how far from the shape, or a particle, the source fades to 0 */
    struct kiln_value rate;   /* 1/s: how fast the gas takes the values; 0: the source is off */
    struct kiln_value fuel, temperature, smoke;
    struct kiln_value3 color;      /* of the smoke, linear; by word: it has none of its own */
    struct kiln_value3 velocity;   /* m/s */
    struct kiln_value outward;     /* m/s, away from the shape's origin, or along a cone's lines */
    struct kiln_value inherit;     /* part of the velocity of the shape, or the particle */
    struct kiln_value noise;       /* part of the values that noise takes away, 0..1 */
    struct kiln_value noise_size;  /* m: of its largest eddies */
    struct kiln_value noise_speed; /* m/s: at which it drifts upwards, and changes */
    bool blows; /* follows: `velocity`, `outward` or `inherit` is given, so velocities count */
};

/* Returns whether the smoke of a source has a colour of its own. */
static inline bool kiln_gas_source_is_colored(const struct kiln_gas_source *source)
{
    return source->color.x.count > 0 || source->color.x.constant != KILN_VALUE_BY_WORD;
}

/* How fuel burns. */
struct kiln_gas_burn {
    bool enabled;               /* false: fuel does not burn, and `burn` has the defaults */
    struct kiln_value ignition; /* temperature from which fuel burns */
    struct kiln_value rate;     /* 1/s: part of the fuel that burns */
    struct kiln_value heat;     /* temperature that a cell full of fuel adds */
    struct kiln_value soot;     /* smoke that it adds */
    struct kiln_value expand;   /* volumes that it adds */
    struct kiln_value life;     /* s: of a flame behind the fire */
    struct kiln_value gain;     /* s: full burning for this long makes a whole flame */
    struct kiln_value clear;    /* 1/s: smoke that burns in a whole flame */
};

struct kiln_gas_turbulence {
    struct kiln_value strength; /* m/s^2; 0: none */
    struct kiln_value size;     /* m: of the largest eddies */
    struct kiln_value speed;    /* m/s: at which the noise rises */
    uint32_t octaves;
};

/* How gas looks. */
struct kiln_gas_look {
    struct kiln_value extinction; /* 1/m, at smoke 1 */
    struct kiln_value3 albedo;    /* of smoke without a colour of its own, linear */
    struct kiln_value scattering; /* g of the phase function, -1..1 */
    union {
        struct kiln_value kelvin[2]; /* at temperature 0 and 1 */
        struct kiln_range kelvins;   /* the same as an option */
    };
    struct kiln_value intensity;  /* radiance a metre of whole flame, at temperature 1 */
    struct kiln_value absorption; /* 1/m: of whole flame */
    struct kiln_value bloom;      /* part of the flame's light that glows */
    struct kiln_value glow;       /* factor on the light of flames in their own smoke */
    struct kiln_value light;      /* and on what is around */
    bool lights;                  /* sun, sky and lamps light the smoke */
    bool shadow;                  /* smoke throws shadows */
    enum kiln_gas_resolution resolution;
};

struct kiln_gas_domain {
    const char *name;
    bool enabled;
    struct kiln_attach attach;
    struct kiln_value3 center, size; /* m: of the box, as given; constant */
    double cell;                     /* m: as given; 0: by `cells` */
    uint32_t cell_count;             /* along the longest edge, as given; by word: by `cell` */
    enum kiln_gas_side sides[6];     /* -x +x -y +y -z +z */
    struct kiln_gas_shape shape;     /* follows */
    double rate;                     /* least steps of the gas a second; 0: one a step */
    uint32_t substeps;               /* of each step of the scene; 0: as many as its speed takes */
    uint32_t substeps_given;         /* the same as an option, whose word is `auto` */
    struct kiln_gas_source sources[KILN_MAX_GAS_SOURCES];
    uint32_t source_count;
    struct kiln_gas_burn burn;
    struct kiln_value buoyancy;  /* m/s^2 upwards at temperature 1 */
    struct kiln_value weight;    /* m/s^2 downwards at smoke 1: smoke_weight */
    struct kiln_value cool_glow; /* 1/s: of radiation, at temperature 1, by its fourth power */
    struct kiln_value cool_even; /* 1/s: temperature lost at any temperature */
    struct kiln_value decay;     /* 1/s: of smoke */
    struct kiln_value vorticity; /* confinement: 0..2 */
    struct kiln_gas_turbulence turbulence;
    struct kiln_value drag; /* 1/s */
    struct kiln_force forces[KILN_MAX_FORCES];
    uint32_t force_count;
    bool collide;    /* with the floor and the objects that collide */
    uint32_t cycles; /* of the pressure's multigrid in a step */
    double residual; /* part of the divergence that may be left; 0: as it comes */
    uint32_t detail; /* factor of the drawn resolution: 1, 2 or 4 */
    struct kiln_gas_look look;
};

#endif
