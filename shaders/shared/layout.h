/* What the host tells a simulation step, laid out alike in C and in a std140 block: every member is
 * a word, or a structure that starts at a multiple of 16 bytes and is one long.
 *
 * The kernels read these as globals in GLSL and through pointers in C: SIM_PARAM and SIM pass them
 * on, SIM_KEYS is their VALUE_KEYS, STEP(x) and AROUND(x) name a member.
 */
#ifndef KILN_SHARED_LAYOUT_H
#define KILN_SHARED_LAYOUT_H

#include "shared/limits.h"
#include "shared/platform.h"
#include "shared/value.h"

/* Births of one step that follow one another at equal distances. Birth j of a group happens at
 * (first + j * spacing) / 2^32 of the step. */
struct kiln_birth_group {
    uint count;
    uint first;
    uint spacing;
    uint unused;
};

/* What is needed to recompute the rest of a particle from its record: see derived.h. */
struct kiln_derived_params {
    uint random_key;
    uint warmup_steps;
    float dt_s;
    uint unused;
    S(kiln_range) life; /* s */
};

#define EMIT_POINT  0u
#define EMIT_SPHERE 1u
#define EMIT_BOX    2u
#define EMIT_DISC   3u
#define EMIT_CONE   4u
#define EMIT_LINE   5u

struct kiln_emit_params {
    uint shape;
    uint outward;
    uint surface;
    uint nozzles;
    S(kiln_range) speed;
    S(kiln_value3) origin;
    S(kiln_value3) direction;
    S(kiln_value3) size;
    S(kiln_value) angle;
    S(kiln_value) radius;
    S(kiln_value) inherit;
    S(kiln_value) turn;
};

#define FORCE_GRAVITY 0u
#define FORCE_DRAG    1u
#define FORCE_WIND    2u
#define FORCE_CURL    3u
#define FORCE_LIMIT   4u
#define FORCE_FIELD   5u
#define FORCE_ATTRACT 6u
#define FORCE_VORTEX  7u

/* How an attraction falls off with the distance. */
#define FALLOFF_INVERSE_SQUARE 0u
#define FALLOFF_INVERSE        1u
#define FALLOFF_CONSTANT       2u
#define FALLOFF_LINEAR         3u

/* How fast the air of a vortex turns, by the distance from its axis. */
#define VORTEX_RANKINE    0u
#define VORTEX_LAMB_OSEEN 1u

struct kiln_force_params {
    uint kind;
    uint octaves;
    uint grid;    /* number, of a field */
    uint profile; /* FALLOFF_* or VORTEX_* */
    S(kiln_value3) vector;
    S(kiln_value3) drift;
    S(kiln_value) strength;
    S(kiln_value) pull;      /* 1/s */
    S(kiln_value) quadratic; /* 1/m */
    S(kiln_value) scale;
    float inward, lift; /* m/s */
    float added; /* 1/s: steps a second where the air's velocity is added in each step, else 0 */
    uint unused;
};

#define INTEGRATE_SEMI_IMPLICIT  0u
#define INTEGRATE_POSITION_FIRST 1u
#define INTEGRATE_TRAPEZOID      2u /* this and what follows: shared/stages.h */
#define INTEGRATE_RK4            3u

/* What some force of a system does. */
#define FORCES_LIMIT 1u /* the speed */
#define FORCES_SLOW  2u /* by the square of the speed */

#define COLLIDE_OFF   0u
#define COLLIDE_SWEPT 1u
#define COLLIDE_CLAMP 2u

/* What a particle is born of: the clock, or an event of a particle of its parent system. */
#define BORN_OF_CLOCK  0u
#define BORN_OF_DEATH  1u
#define BORN_OF_BOUNCE 2u
#define BORN_OF_TRAIL  3u

/* What an emitter's y axis becomes at a birth of a parent. */
#define ALIGN_WORLD    0u
#define ALIGN_VELOCITY 1u
#define ALIGN_NORMAL   2u

/* How a system is related to others: see family.h. */
struct kiln_family_params {
    uint born_of;
    uint align;
    uint slots;         /* reserved for the children of one parent */
    uint parent_traces; /* the first trace of the parent system */
    uint traced;        /* 1: has children or paint, so it leaves traces */
    uint traces;        /* its first trace */
    uint dies;          /* 1: of its first impact */
    uint unused;
    S(kiln_value) rate; /* trail: children a second of the parent's life */
};

struct kiln_step_params {
    S(kiln_derived_params) derived;
    S(kiln_emit_params) emit;
    uint step;
    uint base;         /* the system's first slot in the record buffer */
    uint capacity;     /* its slots */
    uint used;         /* slots that were ever born into, this step's births included */
    uint first_serial; /* of this step's births */
    uint first_slot;   /* where it lives, from base */
    uint birth_count;
    uint group_count;
    uint force_count;
    uint integration;
    uint collide;
    uint demitter_count;
    uint bounded;
    uint noise_seed;
    float time_s;   /* clip time at the start of the step */
    uint forces_do; /* bits FORCES_* */
    S(kiln_value) randomness;
    S(kiln_value) slowdown;
    S(kiln_value) restitution;
    S(kiln_value) friction;
    uint rubs;                 /* 1: restitution and friction matter, its own or those of objects */
    uint pushed;               /* 1: its particles interact, and have pushes */
    uint first_push;           /* of its first slot: see push.h */
    uint spins;                /* 1: its particles turn, and have words for it: see spin.h */
    uint first_spin;           /* of its first slot */
    float spin_low, spin_high; /* rad/s at birth */
    float rolling;             /* resistance: part of what a surface gives */
    float4 spin_axis;          /* at birth, of any length; 0: drawn */
    float4 bounds_min, bounds_max;
    float4 demitter_min[KILN_MAX_DEMITTERS];
    float4 demitter_max[KILN_MAX_DEMITTERS];
    S(kiln_birth_group) groups[KILN_MAX_BIRTH_GROUPS];
    S(kiln_force_params) forces[KILN_MAX_FORCES];
    S(kiln_family_params) family;
};

#define COLLIDER_BOX      0u
#define COLLIDER_SPHERE   1u
#define COLLIDER_CYLINDER 2u
/* In a frame of their own, which may turn (collide_turned.h): */
#define COLLIDER_TURNED_BOX      3u
#define COLLIDER_TURNED_CYLINDER 4u
#define COLLIDER_CAPSULE         5u
#define COLLIDER_PLANE           6u

#define COLLIDER_TERRAIN 16u /* from here on, kinds that look up grids */
#define COLLIDER_SDF     17u
#define COLLIDER_VOLUME  18u
#define VOLUME_TWO_SIDED 0x80000000u
#define COLLIDER_DEPTH   19u

/* A collider at the start and at the end of the step; it moves and turns evenly in between. A box
 * along the axes has min and max alone; those of all others bound it. */
struct kiln_collider {
    float4 min, max;
    float4 min_end, max_end;
    float4 center, center_end; /* all but boxes along the axes: w: radius; what looks up grids has
                                  but that of the ball that meets it (collide_around) */
    float4 axis; /* cylinder: unit; w: half height at the start; plane: its normal then */
    uint kind;
    float half_height_end;
    float restitution, friction; /* factors on a system's */
    /* What follows is of those in a frame of their own. */
    float4 extent, extent_end; /* m: half of the edges, or of the height in y */
    float4 pose;               /* from the frame to the world at the start: a unit quaternion */
    float4 spin;               /* unit; w: the angle by which the step turns it, rad */
    uint grid;                 /* of terrain or of a mesh: its number */
    uint mesh;                 /* likewise, of its pose */
    float steepest;            /* of terrain: m of height for one across its steepest slope */
    uint planes;               /* of a volume: the word of its first, and VOLUME_TWO_SIDED */
};

/* Where a mesh is at the start and at the end of the step: rows from the world to its frame. */
struct kiln_pose {
    float4 to_local[3];
    float4 to_local_end[3];
    float4 metres;             /* for a unit of its frame: at the start, at the end */
    float4 center, center_end; /* m: its origin */
    float4 turn;               /* rad/s, about its axis */
};

/* Samples on a lattice in space; GRID_WORD(i) is the i-th of all grids: see grid.h. Of a volume,
 * the lattice's cells, of which a VOLUME_WORD has four: see collide_volume.h. Of depth maps
 * (collide_depth.h), size has columns, rows, maps and the first word. */
struct kiln_grid {
    float4 origin;    /* m: where the first sample lies */
    float4 per_metre; /* samples, along each axis */
    float4 low, high; /* m: of depth maps: corners of the box around all */
    uint4 size;       /* samples along each axis, at least 2; w: the word of the first */
};

/* What all systems of a scene move among. */
struct kiln_surroundings {
    uint collider_count;
    float steps_per_s;
    uint unused0, unused1;
    S(kiln_collider) colliders[KILN_MAX_COLLIDERS];
    S(kiln_grid) grids[KILN_MAX_GRIDS];
    S(kiln_pose) poses[KILN_MAX_MESHES];
};

#ifdef GL_core_profile
#define SIM
#define SIM_PARAM
#define SIM_KEYS
#define STEP(x)        step_params.x
#define AROUND(x)      surroundings.x
#define GRID_WORD(i)   grid_words[i]
#define PUSH_WORD(i)   push_words[i]
#define SPIN_WORD(i)   spin_words[i]
#define VOLUME_WORD(i) volume_words[i]
#else
struct kiln_sim {
    const struct kiln_step_params *step;
    const struct kiln_surroundings *surroundings;
    const float4 *value_keys;
    const float4 *grid_words;
    const float4 *push_words; /* NULL where no system interacts */
    uint4 *spin_words;        /* NULL where none turns; each slot writes its own */
    const float4 *volume_words;
};
#define SIM            sim,
#define SIM_PARAM      const struct kiln_sim *sim,
#define SIM_KEYS       sim->value_keys,
#define STEP(x)        sim->step->x
#define AROUND(x)      sim->surroundings->x
#define GRID_WORD(i)   sim->grid_words[i]
#define PUSH_WORD(i)   sim->push_words[i]
#define SPIN_WORD(i)   sim->spin_words[i]
#define VOLUME_WORD(i) sim->volume_words[i]
#endif

#endif
