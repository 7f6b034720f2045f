/* Declares the parameters of a simulation step, laid out alike in C and in a std140 block. Every
 * member is a word, or a structure that starts at a multiple of 16 bytes and has such a size.
 *
 * In GLSL the functions read these as globals, in C through pointers. SIM_PARAM and SIM pass them
 * on, SIM_KEYS is their VALUE_KEYS, STEP(x) and AROUND(x) name a member. */
#ifndef KILN_SHARED_LAYOUT_H
#define KILN_SHARED_LAYOUT_H

#include "shared/limits.h"
#include "shared/platform.h"
#include "shared/value.h"

#define BIRTHS_BY_RATE 0u /* the place of a birth is that at the 64th of the step before it */
#define BIRTHS_BY_WAY  1u /* the place of a birth is that at its very time */
#define BIRTHS_BURST   2u /* all are born at one time */

/* Births of one step at equal distances in time. Birth j of a group happens at (first + j *
 * spacing) / 2^32 of the step. */
struct kiln_birth_group {
    uint count;
    uint first;
    uint spacing;
    uint kind; /* BIRTHS_* */
};

/* Parameters by which the values of a particle that its record lacks are recomputed: see
 * derived.h. */
struct kiln_derived_params {
    uint random_key;
    uint warmup_steps;
    float dt_s;
    uint scene_key;     /* random numbers of the scene */
    S(kiln_range) life; /* s */
};

#define EMIT_POINT  0u
#define EMIT_SPHERE 1u
#define EMIT_BOX    2u
#define EMIT_DISC   3u
#define EMIT_CONE   4u
#define EMIT_LINE   5u
/* These look up words in the buffer of the grids (shared/source.h). */
#define EMIT_TRIANGLES 6u
#define EMIT_VERTICES  7u
#define EMIT_IMAGE     8u
#define EMIT_PATH      9u
#define EMIT_POSED     10u /* triangles of a mesh with an animation */
#define EMIT_COLUMNS   11u /* the inside of a mesh */

/* The bits of USES_EMITTERS for particles that move with nodes, and for emitters whose bursts are
 * in order, and that lie in nodes. */
#define EMIT_CARRIED  29u
#define EMIT_ORDERED  30u
#define EMIT_ATTACHED 31u

/* How the births of a burst lie along a shape. */
#define ORDER_RANDOM 0u
#define ORDER_OPEN   1u /* from its first end to its last */
#define ORDER_CLOSED 2u /* all around, so the last is next to the first */

/* The frame of the node that an emitter lies in, during a step. After the part u of the step, its
 * place is a cubic of u, and it has turned by u times the angle of `spin`. */
struct kiln_emit_frame {
    float4 start;  /* m: place at u = 0; w: the scale there */
    float4 linear; /* m: factor of u; w: how much the scale grows in the step */
    float4 square; /* m: factor of u^2; w: steps a second */
    float4 cube;   /* m: factor of u^3 */
    float4 pose;   /* from the frame to the world at the start: a unit quaternion */
    float4 spin;   /* unit axis; w: the angle by which the step turns the frame, rad */
};

/* How a node carries the particles of a system in a step: see carry.h. */
struct kiln_carry {
    S(kiln_emit_frame) frame;
    float4 end;   /* m: place of the frame at the end; w: 1: it jumps there */
    float4 whole; /* how it turns in the whole step, with a jump: a unit quaternion */
    float4 jump;  /* how a jump turns it at the end of the step: a unit quaternion */
};

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
    uint attached;   /* 1: the emitter lies in `frame` */
    uint first_word; /* of the cells of a mesh, an image or a path, in the buffer of the grids */
    uint cells;      /* how many there are to choose from */
    uint order;      /* ORDER_* */
    S(kiln_emit_frame) frame;
};

/* The frame of a node at one time (still_frame.h). */
struct kiln_still_frame {
    float4 at;   /* m: its place; w: metres in one unit of the frame, 0: there is no frame */
    float4 turn; /* from the frame to the world: a unit quaternion */
};

#define FORCE_GRAVITY 0u
#define FORCE_DRAG    1u
#define FORCE_WIND    2u
#define FORCE_CURL    3u
#define FORCE_LIMIT   4u
#define FORCE_FIELD   5u
#define FORCE_ATTRACT 6u
#define FORCE_VORTEX  7u
#define FORCE_BAKED   8u

/* How an attraction falls off with the distance. */
#define FALLOFF_INVERSE_SQUARE 0u
#define FALLOFF_INVERSE        1u
#define FALLOFF_CONSTANT       2u
#define FALLOFF_LINEAR         3u

/* How fast the air of a vortex turns, by the distance from its axis. */
#define VORTEX_RANKINE    0u
#define VORTEX_LAMB_OSEEN 1u

/* The shape of the region in which a force acts. */
#define REGION_NONE   0u /* everywhere */
#define REGION_BOX    1u
#define REGION_SPHERE 2u

/* The options of a force. All kinds have one layout, so some members are of another quantity in
 * each kind: struct kiln_force (lib/scene/force.h) has them by their names. */
struct kiln_force_params {
    uint kind;
    uint octaves;
    uint grid;               /* number of the grid of a field or of a baked wind */
    uint profile;            /* a word of the kind: FALLOFF_* or VORTEX_* */
    S(kiln_value3) vector;   /* an acceleration, a velocity of the air, or a point */
    S(kiln_value3) second;   /* curl: drift; vortex: axis */
    S(kiln_value) strength;  /* limit and vortex: speed */
    S(kiln_value) pull;      /* 1/s */
    S(kiln_value) quadratic; /* 1/m */
    /* curl: size of the eddies; attract, vortex: radius; m; field, baked: 0, or 1 in a node */
    S(kiln_value) scale;
    float inward, lift; /* m/s */
    float added; /* 1/s: steps a second if the air's velocity is added in each step, else 0 */
    uint region; /* REGION_* */
    float4 region_center;      /* m; w: over how many metres inside of the border the force fades */
    float4 region_size;        /* m: half of the edges of a box; x: radius of a sphere */
    S(kiln_still_frame) frame; /* which the force lies in */
    S(kiln_still_frame) region_frame; /* which its region lies in */
};

#define INTEGRATE_SEMI_IMPLICIT  0u
#define INTEGRATE_POSITION_FIRST 1u
#define INTEGRATE_TRAPEZOID      2u /* this integrator and those below: shared/stages.h */
#define INTEGRATE_RK4            3u

/* Bits for effects of a system's forces. */
#define FORCES_LIMIT 1u /* limit the speed */
#define FORCES_SLOW  2u /* quadratic drag */

#define COLLIDE_OFF   0u
#define COLLIDE_SWEPT 1u
#define COLLIDE_CLAMP 2u

/* The origin of a particle: the clock, or an event of a particle of the parent system. */
#define BORN_OF_CLOCK  0u
#define BORN_OF_DEATH  1u
#define BORN_OF_BOUNCE 2u
#define BORN_OF_TRAIL  3u /* of the parent's life, evenly in time */
#define BORN_OF_WAY    4u /* of the parent's life, evenly along its way */

/* The direction of an emitter's y axis at a birth from a parent. */
#define ALIGN_WORLD    0u
#define ALIGN_VELOCITY 1u
#define ALIGN_NORMAL   2u

/* The number of what an impact does to a particle: enum kiln_then. */
#define THEN_BOUNCE 0u
#define THEN_DIE    1u
#define THEN_STOP   2u
#define THEN_STICK  3u

/* Bits that say what records of a system keep: of the dead serial and birth, by which children know
 * their looks; of those that rest the normal of their surface, by which they are drawn, in place of
 * a heading.
 */
#define FAMILY_KEEPS_REMAINS 1u
#define FAMILY_KEEPS_NORMALS 2u

/* How a system is related to others: see family.h. */
struct kiln_family_params {
    uint born_of;
    uint align;
    uint slots;         /* slots reserved for the children of one parent */
    uint parent_traces; /* index of the parent system's first trace */
    uint traced;        /* 1: the system has children or paint, so it leaves traces */
    uint traces;        /* index of its own first trace */
    uint then;          /* THEN_* */
    uint impacts;       /* 1: a parent's death at an impact counts as a death */
    uint fewest, most;  /* death, bounce: children of an event, drawn between the two */
    uint counted;     /* the impacts that its particles count: 1, or up to the last with children */
    uint travels;     /* 1: its particles have ways (family_way.h) */
    uint ways;        /* row of its first way among spins and ways */
    uint parent_ways; /* that of the parent system */
    float per_metre;  /* way: children a metre of the parent's way */
    uint keeps;       /* FAMILY_KEEPS_* */
    S(kiln_value) rate;   /* trail: children a second of the parent's life */
    S(kiln_value) chance; /* of an impact to do what `then` says, and not to let it bounce */
};

struct kiln_step_params {
    S(kiln_derived_params) derived;
    S(kiln_emit_params) emit;
    uint step;
    uint base;         /* the system's first slot in the record buffer */
    uint capacity;     /* its slots */
    uint used;         /* slots that ever had a birth, including this step's */
    uint first_serial; /* serial of the first birth of this step */
    uint first_slot;   /* slot of that birth, counted from base */
    uint birth_count;
    uint group_count;
    uint force_count;
    uint integration;
    uint collide;
    uint demitter_count;
    uint bounded;
    uint noise_seed;
    float time_s;   /* clip time at the start of the step */
    uint forces_do; /* bit mask of FORCES_* */
    S(kiln_value) randomness;
    S(kiln_value) slowdown;
    S(kiln_value) restitution;
    S(kiln_value) friction;
    /* 1: restitution and friction are not 1 and 0, of the system or of objects */
    uint rubs;
    uint pushed;               /* 1: particles of the system interact, and have pushes */
    uint first_push;           /* push of its first slot: see push.h */
    uint spins;                /* 1: particles of the system spin: see spin.h */
    uint first_spin;           /* spin of its first slot */
    float spin_low, spin_high; /* rad/s at birth */
    float rolling;             /* lever arm of rolling resistance, in radii */
    /* axis of the spin at birth, of any length; 0: random for each particle */
    float4 spin_axis;
    float4 bounds_min, bounds_max;
    float4 demitter_min[KILN_MAX_DEMITTERS];
    float4 demitter_max[KILN_MAX_DEMITTERS];
    S(kiln_still_frame) demitter_frames[KILN_MAX_DEMITTERS]; /* which they lie in */
    S(kiln_birth_group) groups[KILN_MAX_BIRTH_GROUPS];
    S(kiln_force_params) forces[KILN_MAX_FORCES];
    S(kiln_family_params) family;
    uint carried; /* 1: particles of the system move with a node */
    uint unused0, unused1, unused2;
    S(kiln_carry) carry;
};

#define COLLIDER_BOX      0u
#define COLLIDER_SPHERE   1u
#define COLLIDER_CYLINDER 2u
/* Shapes in frames of their own, which may turn (collide_oriented.h): */
#define COLLIDER_ORIENTED_BOX      3u
#define COLLIDER_ORIENTED_CYLINDER 4u
#define COLLIDER_CAPSULE           5u
#define COLLIDER_PLANE             6u
#define COLLIDER_CONE              7u

#define COLLIDER_TERRAIN 16u /* this kind and those below look up grids */
#define COLLIDER_SDF     17u
#define COLLIDER_VOLUME  18u
#define VOLUME_TWO_SIDED 0x80000000u
#define COLLIDER_DEPTH   19u

/* A collider at the start and at the end of the step; it moves and turns evenly in between. min and
 * max are the whole shape of a box along the axes, and bounds of all others. */
struct kiln_collider {
    /* bounds at the start and at the end; the w of the first three, unless it is terrain or a mesh:
     * the rotation of the step, axis times angle, rad, by which it carries what rides on it */
    float4 min, max;
    float4 min_end, max_end;
    /* all but boxes along the axes; w: radius; of a collider with a grid, w is the radius of the
     * ball that meets it (collide_around) */
    float4 center, center_end;
    float4 axis; /* cylinder: unit axis; w: half height at the start; plane: its normal then */
    uint kind;
    float half_height_end;
    float restitution, friction; /* factors on the system's restitution and friction */
    /* The members below are for shapes in frames of their own. */
    /* m: half of the edges, or of the height in y; w: radius of the ball that meets a cone
     * (collide_around) */
    float4 extent, extent_end;
    float4 pose; /* from the frame to the world at the start: a unit quaternion */
    float4 spin; /* unit; w: the angle by which the step turns it, rad */
    uint grid;   /* number of the grid of terrain or of a mesh */
    uint mesh;   /* number of the pose of a mesh */
    /* m by which a ball of radius 1 m enlarges bounds: terrain over its steepest slope, a cone at
     * its edges */
    float steepest;
    uint planes; /* volume: the word of its first plane, and VOLUME_TWO_SIDED */
};

/* A mesh's place at the start and at the end of the step: rows from the world to its frame. */
struct kiln_pose {
    float4 to_local[3];
    float4 to_local_end[3];
    float4 metres;             /* metres in one unit of its frame: at the start, at the end */
    float4 center, center_end; /* m: its origin */
    float4 turn;               /* rad/s, about an axis through the origin */
};

/* Samples on a lattice in space; GRID_WORD(i) is the i-th word of all grids: see grid.h. For a
 * volume, the lattice is that of its cells, four of which share a VOLUME_WORD: see
 * collide_volume.h. For depth maps (papers/collide_depth.h), size has columns, rows, maps and the
 * first word. */
struct kiln_grid {
    float4 origin;    /* m: place of the first sample */
    float4 per_metre; /* samples a metre, along each axis */
    float4 low, high; /* m: depth maps: corners of the box around all maps; baked winds: high is
                       * from one sample to the next along each axis */
    uint4 size;       /* samples along each axis, at least 2; w: index of the first word */
};

/* The colliders and grids around all systems of a scene. */
struct kiln_surroundings {
    uint collider_count;
    float steps_per_s;
    uint unused0, unused1;
#if defined(GL_core_profile) && !defined(SURROUNDINGS_STORED)
    S(kiln_collider) colliders[KILN_BLOCK_COLLIDERS];
    S(kiln_grid) grids[KILN_BLOCK_GRIDS];
    S(kiln_pose) poses[KILN_BLOCK_MESHES];
#else
    S(kiln_collider) colliders[KILN_MAX_COLLIDERS];
    S(kiln_grid) grids[KILN_MAX_GRIDS];
    S(kiln_pose) poses[KILN_MAX_MESHES];
#endif
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
    const float4 *push_words; /* NULL if no system interacts */
    uint4 *spin_words;        /* spins and ways; NULL if there are none; each slot writes its own */
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
