/* This header declares the appearance of living particles on the host: position, size, opacity,
 * pose. Stages that visit particles one by one on the CPU use it: the light of fire, the shadows of
 * smoke and of solid particles, and solid particles drawn on the host. */
#ifndef KILN_DRAW_MOMENT_APPEARANCE_H
#define KILN_DRAW_MOMENT_APPEARANCE_H

#include "draw/moment/moment.h"
#include "shared/instance.h"

/* Holds the data from which the particles of one system are computed. */
struct kiln_appearance_system {
    struct kiln_derived_params derived;
    const float4 *keys;
    const struct kiln_particle *records;     /* the system's records, by slot */
    const float4 *rows;                      /* the system's rows of the look table */
    const float4 *table;                     /* the whole look table */
    const struct kiln_look_program *program; /* values of the look over other clocks than life */
    float3 eye;                              /* of the camera, m */
    float time_s;                            /* clip time of the moment */
    uint32_t used;                           /* only slots below this number may hold a particle */
    uint32_t step;                           /* number of steps so far */
    float back;                    /* from the moment to the end of these steps, in steps */
    float dt_s;                    /* duration of a step, s */
    const struct kiln_spin *spins; /* by slot; NULL: collisions do not turn the particles */
    /* if the look inherits values of the parent's: parameters and records of the parent's system,
     * and the slots of one parent's children; else 0 */
    struct kiln_derived_params of_parent;
    const struct kiln_particle *parents;
    uint32_t slots_of_parent;
};

/* Describes a living particle at the moment's time. */
struct kiln_appearance {
    float3 position; /* m */
    float radius;    /* half of the billboard's edge, m */
    float progress;  /* through its life, 0 to 1 */
    float opacity;   /* opacity at this age, with the fades at birth and death */
    struct value_clocks clocks;
};

/* Returns the data from which the particles of one system are computed. The moment must have been
 * filled with on_host and must outlive the result. */
struct kiln_appearance_system kiln_appearance_system(const struct kiln_moment *moment,
                                                     uint32_t index);

/* Computes the particle in a slot; returns false when no particle lives there. */
bool kiln_appearance_at(const struct kiln_appearance_system *system, uint32_t slot,
                        struct kiln_appearance *particle);

/* Returns the clocks of the particle in a slot, at an age and a progress through its life. */
struct value_clocks kiln_appearance_clocks(const struct kiln_appearance_system *system,
                                           uint32_t slot, float age_s, float progress);

/* Returns a row of the system's look (KILN_LOOK_*) for a particle. */
float4 kiln_appearance_look(const struct kiln_appearance_system *system, uint32_t row,
                            const struct value_clocks *clocks);

/* Returns the orientation of a sphere in the world, a unit quaternion: it follows from collisions,
 * or else from the rotation and spin of the look. */
float4 kiln_appearance_pose(const struct kiln_appearance_system *system, uint32_t slot,
                            const struct value_clocks *clocks);

/* Returns the world-space axes of a particle that is a mesh; orient: enum kiln_orient, from its
 * look. */
struct instance_axes kiln_appearance_axes(const struct kiln_appearance_system *system,
                                          uint32_t slot, const struct value_clocks *clocks,
                                          uint32_t orient);

/* Returns the light that a particle emits: the mean of the light of its hot and of its cool
 * parts. */
float3 kiln_appearance_glow(const struct kiln_appearance_system *system,
                            const struct value_clocks *clocks);

#endif
