/* Declares what particles do at collisions (Heinz 2019, 3.5), and the paint that they leave. */
#ifndef KILN_SCENE_COLLIDE_H
#define KILN_SCENE_COLLIDE_H

#include <stdbool.h>

#include "option/values.h"

enum kiln_collide_mode {
    KILN_COLLIDE_SWEPT, /* exact point of impact along the path of the step */
    KILN_COLLIDE_CLAMP, /* the thesis: a position inside is clamped to the nearest face */
};

/* Names what an impact does to a particle. */
enum kiln_then {
    KILN_THEN_BOUNCE,
    KILN_THEN_DIE,
    KILN_THEN_STOP,  /* it rests in the world where it hit, until its life ends */
    KILN_THEN_STICK, /* it rides the object that it hit, until its life ends */
};

struct kiln_collide {
    bool enabled;
    bool dies; /* the same as KILN_THEN_DIE, by the key of older scenes */
    enum kiln_then then;
    struct kiln_value chance; /* 0..1: of the first impact in a step to do what `then` says */
    enum kiln_collide_mode mode;
    struct kiln_value randomness;  /* 0 mirror .. 1 any direction of the hemisphere */
    struct kiln_value slowdown;    /* factor on the speed, 0..1 */
    struct kiln_value restitution; /* 0..1: of the speed along the normal */
    struct kiln_value friction;    /* Coulomb's coefficient */
};

/* ---- paint: Drone 2007, 7.6.1 ---------------------------------------------------------------- */

enum kiln_paint_when {
    KILN_PAINT_IMPACT, /* at the place of the first impact of a step */
    KILN_PAINT_NEAR,   /* as in the paper: at the particle's place at the end of a step */
};

/* The splats that particles leave on meshes that take paint, in look.color. */
struct kiln_painting {
    bool enabled;
    enum kiln_paint_when when;
    struct kiln_range radius;  /* m */
    struct kiln_value opacity; /* 0..1: opacity in the middle */
    struct kiln_value soft;    /* 0..1: outer part of the radius over which it fades */
};

#endif
